#include "vmech/hw_interface/haply/haply_master.h"

#include <fmt/format.h>
#include <poll.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <stdexcept>

#include "vmech/base/check_range.h"
#include "vmech/hw_interface/haply/web_socket_client.h"

namespace vmech {
namespace {

constexpr double kOpen = 0.8;        // [rad] of the gripper while its button is not pressed
constexpr double kPatience = 10e-3;  // [s] between two looks whether the master is to end

std::int64_t Now() noexcept {
  return std::chrono::nanoseconds(std::chrono::steady_clock::now().time_since_epoch()).count();
}

}  // namespace

void HaplyOptions::Validate() const {
  CheckRange("HaplyOptions", "port", port, 1, 65535);
  CheckRange("HaplyOptions", "period", period, 2.5e-4, 0.1);
  CheckRange("HaplyOptions", "connect_timeout", connect_timeout, 0.01, 60);
  CheckRange("HaplyOptions", "link_timeout", link_timeout, 1e-3, 10);
}

HaplyMaster::HaplyMaster(HaplyOptions options) : options_(options) {
  options_.Validate();
}

HaplyMaster::~HaplyMaster() {
  Shutdown();
}

DeviceInfo HaplyMaster::OnConfigure() {
  const auto fail = [&](const std::string& what) {
    throw std::runtime_error(fmt::format(
        "haply: {}; start Haply's Inverse Service, and see there whether the device is ready",
        what));
  };
  std::string first;
  try {
    socket_ = std::make_unique<WebSocketClient>(options_.port, "/", options_.connect_timeout);
    if (socket_->Receive(options_.connect_timeout, &first) != WebSocketClient::Arrival::kText) {
      fail(fmt::format("127.0.0.1:{} says nothing", options_.port));
    }
    const std::optional<HaplyDevice> device = ReadHaplyDevice(first);
    if (!device) fail(fmt::format("127.0.0.1:{} knows of no Inverse3", options_.port));
    device_ = *device;
  } catch (const std::runtime_error& error) {
    if (std::string_view(error.what()).starts_with("haply: ")) throw;
    fail(error.what());
  }
  if (!device_.calibrated) fail(fmt::format("Inverse3 {} is not calibrated", device_.id));
  bell_ = ::eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC);
  start_ns_ = Now();
  conversation_ = std::thread([this] { Converse(); });

  DeviceInfo info;
  info.name = "Haply Inverse3 " + device_.id;
  info.period = options_.period;
  info.delay = options_.period;  // a force is answered with the state of the next message
  info.senses = kSensesPose | kSensesTwist;
  if (device_.tells_force) info.senses |= kSensesAppliedWrench;
  if (device_.has_grip) info.senses |= kSensesButtons | kSensesGripper;
  info.takes_wrench = true;
  info.linear = options_.linear;
  return info;
}

void HaplyMaster::OnShutdown() noexcept {
  over_ = true;
  if (conversation_.joinable()) conversation_.join();
  if (bell_ >= 0) ::close(bell_);
  bell_ = -1;
  socket_.reset();
}

/// One message, one answer, for as long as both sides are there.
void HaplyMaster::Converse() {
  std::string text;
  while (!over_ && !lost_) {
    AwaitWish();
    const bool answered =
        socket_->Send(HaplyForceCommand(device_, WishedForce())) && TakeAnswer(&text);
    if (!answered) {
      lost_ = true;
      continue;
    }
    const std::optional<HaplySample> state = ReadHaplyState(text, device_.id);
    if (state && state->position) {
      samples_.back() = {*state, Now()};
      samples_.Publish();
    } else {
      ++malformed_;
    }
  }
  if (!lost_) socket_->Send(HaplyForceCommand(device_, Vector3d::Zero()));
}

/// Until the loop has written, or a few periods have passed without.
void HaplyMaster::AwaitWish() const noexcept {
  constexpr int kPeriods = 3;
  pollfd bell{bell_, POLLIN, 0};
  const int wait_ms = std::max(1, static_cast<int>(1e3 * kPeriods * options_.period));
  std::uint64_t rings = 0;
  if (::poll(&bell, 1, wait_ms) > 0) (void)!::read(bell_, &rings, sizeof rings);
}

/// The newest that is still wanted.
Vector3d HaplyMaster::WishedForce() noexcept {
  wishes_.Take();
  const Wish& wish = wishes_.front();
  if (Now() < wish.until_ns) return wish.force;
  return Vector3d::Zero();
}

/// False if none comes any more.
bool HaplyMaster::TakeAnswer(std::string* text) {
  while (!over_) {
    switch (socket_->Receive(kPatience, text)) {
      case WebSocketClient::Arrival::kText:
        return true;
      case WebSocketClient::Arrival::kClosed:
        return false;
      case WebSocketClient::Arrival::kNothing:
        break;
    }
  }
  return true;
}

IoStatus HaplyMaster::OnRead(std::int64_t now_ns, MasterState* state) noexcept {
  read_ns_ = now_ns;
  const bool fresh = samples_.Take();
  const Sample& sample = samples_.front();
  const double age = 1e-9 * static_cast<double>(Now() - std::max(sample.at_ns, start_ns_));
  if (fresh) Tell(sample, &newest_);
  const bool gone = lost_ || age > options_.link_timeout;
  if (gone) newest_.valid = 0;  // what it says is of another time
  *state = newest_;
  if (gone) return IoStatus::kLinkLost;
  return fresh ? IoStatus::kOk : IoStatus::kNoNewData;
}

void HaplyMaster::Tell(const Sample& sample, MasterState* state) noexcept {
  const auto period_ns = static_cast<std::int64_t>(1e9 * options_.period);
  const std::int64_t since_ns = sample.at_ns - start_ns_;
  const auto slot = static_cast<std::uint64_t>((since_ns + period_ns / 2) / period_ns);
  state->sequence = std::max(state->sequence + 1, slot);
  state->device_time_ns = since_ns;
  state->valid = info().senses;
  state->dead_man = true;
  state->X_DH.p = *sample.state.position;
  if (sample.state.orientation) state->X_DH.R = sample.state.orientation->toRotationMatrix();
  state->V_DH.head<3>() = sample.state.velocity.value_or(Vector3d::Zero());
  if (!sample.state.velocity) state->valid &= ~static_cast<std::uint32_t>(kSensesTwist);
  state->applied_F_Ho_D.head<3>() = sample.state.force.value_or(Vector3d::Zero());
  if (!sample.state.force) state->valid &= ~static_cast<std::uint32_t>(kSensesAppliedWrench);
  state->buttons = sample.state.buttons;
  state->gripper_opening = (state->buttons & 1u) != 0 ? 0 : kOpen;
}

/// A command of a loop in simulated time lives as long in real time.
IoStatus HaplyMaster::OnWrite(const MasterCommand& command) noexcept {
  constexpr std::int64_t kLongest = 100'000'000;  // [ns]
  const bool wanted = command.mode == CommandMode::kWrench;
  Wish& wish = wishes_.back();
  wish.force = wanted ? Vector3d(command.F_Ho_D.head<3>()) : Vector3d::Zero();
  wish.until_ns = Now() + std::clamp<std::int64_t>(command.valid_until_ns - read_ns_, 0, kLongest);
  wishes_.Publish();
  constexpr std::uint64_t kOnce = 1;
  (void)!::write(bell_, &kOnce, sizeof kOnce);
  return lost_ ? IoStatus::kLinkLost : IoStatus::kOk;
}

}  // namespace vmech
