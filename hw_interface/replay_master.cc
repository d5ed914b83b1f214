#include "vmech/hw_interface/replay_master.h"

#include <fmt/format.h>

#include <stdexcept>

namespace vmech {

ReplayMaster::ReplayMaster(Recording recording) : recording_(std::move(recording)) {
  if (recording_.ticks.empty()) {
    throw std::invalid_argument(
        fmt::format("replay of '{}': the recording has no ticks", recording_.device));
  }
}

DeviceInfo ReplayMaster::OnConfigure() {
  DeviceInfo info;
  info.name = "replay of " + recording_.device;
  info.period = recording_.period;
  info.senses = recording_.ticks.front().state.valid & ~(kSensesAppliedWrench | kSensesEcho);
  info.takes_wrench = true;
  info.linear.peak = info.angular.peak = 1e3;  // nothing is at work
  return info;
}

IoStatus ReplayMaster::OnRead(std::int64_t, MasterState* state) noexcept {
  if (finished()) return IoStatus::kNoNewData;
  *state = recording_.ticks[next_++].state;
  state->valid &= info().senses;
  return IoStatus::kOk;
}

}  // namespace vmech
