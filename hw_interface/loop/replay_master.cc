#include "vmech/hw_interface/loop/replay_master.h"

#include <fmt/format.h>

#include <stdexcept>

namespace vmech {

ReplayMaster::ReplayMaster(Recording recording, ReplayKind kind)
    : recording_(std::move(recording)), kind_(kind) {
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
  for (const TickRecord& tick : recording_.ticks) senses |= tick.state.valid;
  if (kind_ == ReplayKind::kSession) {
    info.name = recording_.device;
    for (const TickRecord& tick : recording_.ticks) info.observed |= tick.observed;
    info.senses = senses;
    info.delay = recording_.delay;
    info.linear = recording_.linear;
    info.angular = recording_.angular;
  } else {
    info.name = "replay of " + recording_.device;
    info.senses = senses & ~(kSensesAppliedWrench | kSensesEcho);
    info.linear.peak = info.angular.peak = 1e3;  // nothing is at work
  }
  return info;
}

IoStatus ReplayMaster::OnRead(std::int64_t, MasterState* state) noexcept {
  if (finished()) return IoStatus::kNoNewData;
  const TickRecord& tick = recording_.ticks[next_++];
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
