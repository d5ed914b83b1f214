#include "vmech/hw_interface/loop/replay_master.h"

#include <fmt/format.h>

#include <stdexcept>

namespace vmech {

ReplayMaster::ReplayMaster(Recording recording, ReplayKind kind, int hand)
    : recording_(std::move(recording)), kind_(kind), index_(hand) {
  if (hand < 0 || hand >= recording_.hands()) {
    throw std::invalid_argument(fmt::format("replay of '{}': hand {} of {}", recording_.device,
                                            hand + 1, recording_.hands()));
  }
  if (recording_.ticks.empty()) {
    throw std::invalid_argument(
        fmt::format("replay of '{}': the recording has no ticks", recording_.device));
  }
}

DeviceInfo ReplayMaster::OnConfigure() {
  DeviceInfo info;
  info.period = recording_.period;
  info.takes_wrench = true;
  std::uint32_t senses = 0;  // a sample may lack what the device senses
  bool observed = false;
  for (const TickRecord& tick : recording_.ticks) {
    senses |= tick.of_hand(index_).state.valid;
    observed |= tick.of_hand(index_).observed;
  }
  const RecordedDevice& device =
      index_ == 0 ? recording_ : recording_.others[static_cast<std::size_t>(index_ - 1)];
  if (kind_ == ReplayKind::kSession) {
    info.name = device.device;
    info.observed = observed;
    info.senses = senses;
    info.delay = device.delay;
    info.linear = device.linear;
    info.angular = device.angular;
  } else {
    info.name = "replay of " + device.device;
    info.senses = senses & ~(kSensesAppliedWrench | kSensesEcho);
    info.linear.peak = info.angular.peak = 1e3;  // nothing is at work
  }
  return info;
}

IoStatus ReplayMaster::OnRead(std::int64_t, MasterState* state) noexcept {
  if (finished()) return IoStatus::kNoNewData;
  const HandRecord& tick = recording_.ticks[next_++].of_hand(index_);
  *state = tick.state;
  state->valid &= info().senses;
  observed_ = tick.observed;
  hand_ = tick.hand.Moving();
  if (kind_ == ReplayKind::kSession) room_ = tick.room;
  return kind_ == ReplayKind::kSession ? tick.io : IoStatus::kOk;
}

const MovingFrame* ReplayMaster::ObservedHand() const noexcept {
  return kind_ == ReplayKind::kSession && observed_ ? &hand_ : nullptr;
}

}  // namespace vmech
