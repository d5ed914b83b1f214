#include "vmech/hw_interface/remote/udp_server.h"

#include <algorithm>

#include "vmech/base/check_range.h"
#include "vmech/hw_interface/arm/sarcos_arm.h"

namespace vmech {

SafetyOptions DeviceLimits() {
  SafetyOptions limits;
  limits.soft_start = 0;
  limits.force_slew = 5e4;
  limits.moment_slew = 2500;
  // A store that only the host knows may give energy for as long as it likes.
  limits.energy_trip = 100;
  limits.passivity.enabled = false;
  limits.passivity.credit = 10;
  limits.passivity.forgiven = 10;
  return limits;
}

void UdpServerOptions::Validate() const {
  CheckRange("UdpServerOptions", "hold", hold, 0, 0.1);
  CheckRange("UdpServerOptions", "ramp", ramp, 1e-3, 1);
  CheckRange("UdpServerOptions", "release", release, 0.1, 60);
}

UdpServer::UdpServer(const UdpServerOptions& options, Master* device)
    : options_(options),
      device_(device),
      socket_(options.local),
      limits_(options.limits, device->info()) {
  options_.Validate();
}

void UdpServer::Step(std::int64_t now_ns) {
  sockaddr_in from{};
  while (const auto bytes = socket_.Receive(&from)) {
    if (Decode(*bytes, &in_)) {
      Take(from, now_ns);
    } else {
      ++statistics_.malformed;
    }
  }
  const bool silent = static_cast<double>(now_ns - heard_ns_) * 1e-9 > options_.release;
  if (session_ != 0 && silent) EndSession();
  ServeDevice(now_ns);
}

void UdpServer::Take(const sockaddr_in& from, std::int64_t now_ns) {
  const PacketHeader& header = in_.header;
  if (session_ == 0 && header.kind == PacketKind::kHello && header.session != 0) {
    session_ = header.session;
    last_sequence_ = 0;
  }
  if (header.session != session_ || session_ == 0) {
    ++statistics_.malformed;
    return;
  }
  if (header.sequence <= last_sequence_) {
    ++statistics_.stale;
    return;
  }
  ++statistics_.received;
  if (last_sequence_ > 0) statistics_.missing += header.sequence - last_sequence_ - 1;
  statistics_.round_trip_ns = now_ns - header.reflected_sent_ns;
  last_sequence_ = header.sequence;
  host_ = from;
  heard_ns_ = now_ns;
  out_.header.reflected_sent_ns = header.sent_ns;
  if (header.kind == PacketKind::kHello) Answer(PacketKind::kInfo, now_ns);
  if (header.kind == PacketKind::kBye) EndSession();
  if (header.kind == PacketKind::kCommand) {
    command_ = in_.command;
    commanded_ns_ = now_ns;
  }
}

void UdpServer::Answer(PacketKind kind, std::int64_t now_ns) noexcept {
  out_.header.kind = kind;
  out_.header.session = session_;
  ++out_.header.sequence;
  out_.header.sent_ns = now_ns;
  if (kind == PacketKind::kInfo) out_.info = device_->info();
  socket_.Send(out_, host_);
}

/// What is left of the last command: 1, then down to 0 in a straight line.
double UdpServer::Share(std::int64_t now_ns) const noexcept {
  const double age = static_cast<double>(now_ns - commanded_ns_) * 1e-9;
  const double hold = std::min(options_.hold, static_cast<double>(command_.lifetime_ns) * 1e-9);
  return std::clamp(1 - (age - hold) / options_.ramp, 0.0, 1.0);
}

void UdpServer::ServeDevice(std::int64_t now_ns) {
  const IoStatus io = device_->Read(now_ns, &out_.state);
  const double share = session_ != 0 && command_.active ? Share(now_ns) : 0;
  if (share == 0 && limits_.latched() != ForceOff::kNone) limits_.Unlatch();
  if (share > 0 && device_->lifecycle() == Lifecycle::kInactive) device_->Activate();
  if (share == 0) device_->Deactivate();

  MasterCommand wanted = command_.command;
  wanted.F_Ho_D *= share;
  wanted.gripper_torque *= share;
  wanted.valid_until_ns = now_ns + static_cast<std::int64_t>(1e9 * (options_.hold + options_.ramp));
  const MasterCommand safe = WithinLimits(wanted, io);
  if (device_->lifecycle() == Lifecycle::kActive) (void)device_->Write(safe);

  const bool tripped = limits_.latched() != ForceOff::kNone;
  out_.fault = io == IoStatus::kDeviceFault || device_->lifecycle() == Lifecycle::kFault || tripped;
  const bool news = io == IoStatus::kOk || out_.fault;
  if (news && session_ != 0) Answer(PacketKind::kState, now_ns);
}

MasterCommand UdpServer::WithinLimits(MasterCommand command, IoStatus io) noexcept {
  MasterState state = out_.state;
  state.valid &= ~static_cast<std::uint32_t>(kSensesEcho);  // it counts the host's commands
  const SafetyOutput safe =
      limits_.Apply({device_->lifecycle(), io, &state, command.F_Ho_D, /*stored_energy=*/0});
  command.F_Ho_D = safe.F_Ho_D;
  const double gripper = GripperRange{}.torque_limit;
  command.gripper_torque = std::clamp(command.gripper_torque, -gripper, gripper);
  if (safe.off != ForceOff::kNone) {
    command.mode = CommandMode::kZero;
    command.gripper_torque = 0;
  }
  return command;
}

void UdpServer::EndSession() noexcept {
  session_ = 0;
  command_ = RemoteCommand{};
  device_->Deactivate();
}

}  // namespace vmech
