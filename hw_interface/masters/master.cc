#include "vmech/hw_interface/masters/master.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "vmech/base/check_range.h"

namespace vmech {
namespace {

/// What any device can be; gains, clamps and the loop's period are computed from it.
void CheckPhysics(const DeviceInfo& info) {
  const std::string device = fmt::format("device '{}'", info.name);
  constexpr double kNoLimit = std::numeric_limits<double>::infinity();
  if (!(info.senses & kSensesPose)) {
    throw std::logic_error(device +
                           " states that it senses no pose (kSensesPose of DeviceInfo::senses): "
                           "there is no hand to follow");
  }
  CheckRange(device, "period", info.period, 1e-6, 1);
  CheckRange(device, "delay", info.delay, 0, 1);
  for (const HandlePhysics* handle : {&info.linear, &info.angular}) {
    const std::string part = device + (handle == &info.linear ? ".linear" : ".angular");
    CheckRange(part, "mass", handle->mass, 0, 1e6);
    CheckRange(part, "damping", handle->damping, 0, 1e6);
    CheckRange(part, "coulomb", handle->coulomb, 0, 1e6);
    CheckRange(part, "resolution", handle->resolution, 0, 1);
    CheckRange(part, "peak", handle->peak, 0, 1e6);
    CheckRange(part, "max_speed", handle->max_speed, 0, kNoLimit);
  }
}

}  // namespace

void Master::Require(Lifecycle wanted, const char* verb) const {
  if (lifecycle_ == wanted) return;
  throw std::logic_error(fmt::format("master '{}' is {}: {} needs it {}", info_.name,
                                     NameOf(lifecycle_), verb, NameOf(wanted)));
}

void Master::Configure() {
  Require(Lifecycle::kUnconfigured, "Configure");
  DeviceInfo info = OnConfigure();
  try {
    CheckPhysics(info);
  } catch (...) {
    OnShutdown();
    throw;
  }
  info_ = std::move(info);
  lifecycle_ = Lifecycle::kInactive;
}

void Master::Activate() {
  Require(Lifecycle::kInactive, "Activate");
  OnActivate();
  lifecycle_ = Lifecycle::kActive;
}

void Master::Deactivate() noexcept {
  if (lifecycle_ != Lifecycle::kActive) return;
  lifecycle_ = Lifecycle::kInactive;
  OnWrite(MasterCommand{});
  OnDeactivate();
}

void Master::Recover() {
  Require(Lifecycle::kFault, "Recover");
  OnRecover();
  lifecycle_ = Lifecycle::kInactive;
}

void Master::Shutdown() noexcept {
  Deactivate();
  if (lifecycle_ != Lifecycle::kFinalized && lifecycle_ != Lifecycle::kUnconfigured) OnShutdown();
  lifecycle_ = Lifecycle::kFinalized;
}

IoStatus Master::Read(std::int64_t now_ns, MasterState* state) noexcept {
  if (lifecycle_ == Lifecycle::kUnconfigured || lifecycle_ == Lifecycle::kFinalized) {
    return IoStatus::kNoNewData;
  }
  const IoStatus status = WithPose(OnRead(now_ns, state), state);
  state->host_time_ns = now_ns;
  if (status == IoStatus::kDeviceFault) lifecycle_ = Lifecycle::kFault;
  return status;
}

IoStatus Master::WithPose(IoStatus status, MasterState* state) noexcept {
  if (status != IoStatus::kOk) return status;
  const std::uint32_t needed = kSensesPose | (info_.senses & kSensesJoints);
  if ((state->valid & needed) == needed) {
    last_ = *state;
    return status;
  }
  const std::uint32_t buttons = state->valid & kSensesButtons ? state->buttons : last_.buttons;
  const bool dead_man = state->dead_man, emergency_stop = state->emergency_stop;
  *state = last_;
  state->buttons = buttons;
  state->dead_man = dead_man;
  state->emergency_stop = emergency_stop;
  return IoStatus::kNoNewData;
}

IoStatus Master::Write(const MasterCommand& command) noexcept {
  if (lifecycle_ == Lifecycle::kUnconfigured || lifecycle_ == Lifecycle::kFinalized) {
    return IoStatus::kRefused;
  }
  if (lifecycle_ != Lifecycle::kActive) {
    MasterCommand zero;
    zero.sequence = command.sequence;
    return OnWrite(zero);
  }
  const bool taken = command.mode == CommandMode::kZero ||
                     (command.mode == CommandMode::kWrench && info_.takes_wrench) ||
                     (command.mode == CommandMode::kJointTorque && info_.takes_torque);
  return taken ? OnWrite(command) : IoStatus::kRefused;
}

double PeriodsBetween(const MasterState& earlier, const MasterState& later,
                      double period) noexcept {
  constexpr double kLate = 8;
  const auto counted = static_cast<double>(later.sequence - earlier.sequence);
  const double on_host = 1e-9 * static_cast<double>(later.host_time_ns - earlier.host_time_ns);
  return std::max(1.0, std::min(counted, on_host / period + kLate));
}

const char* NameOf(Lifecycle lifecycle) noexcept {
  switch (lifecycle) {
    case Lifecycle::kUnconfigured:
      return "unconfigured";
    case Lifecycle::kInactive:
      return "inactive";
    case Lifecycle::kActive:
      return "active";
    case Lifecycle::kFault:
      return "at fault";
    case Lifecycle::kFinalized:
      return "finalized";
  }
  return "";
}

const char* NameOf(IoStatus status) noexcept {
  switch (status) {
    case IoStatus::kOk:
      return "ok";
    case IoStatus::kNoNewData:
      return "no new data";
    case IoStatus::kLinkLost:
      return "link lost";
    case IoStatus::kDeviceFault:
      return "device fault";
    case IoStatus::kRefused:
      return "refused";
  }
  return "";
}

}  // namespace vmech
