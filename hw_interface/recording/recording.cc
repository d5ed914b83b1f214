#include "vmech/hw_interface/recording/recording.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <system_error>

#include "vmech/base/screw_algebra.h"

namespace vmech {

RecordedHand RecordedHand::Of(const MovingFrame& hand_D) noexcept {
  return {PoseOf(hand_D.X), Vector6Of(hand_D.V)};
}

MovingFrame RecordedHand::Moving() const noexcept {
  return {FrameOf(X_DH), ScrewOf(V_DH)};
}

std::string RecordingHeader::Note(std::string_view wanted) const {
  for (const auto& [key, text] : notes) {
    if (key == wanted) return text;
  }
  return {};
}

double RecordingHeader::Number(std::string_view wanted, double otherwise) const {
  const std::string text = Note(wanted);
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  const bool sound = error == std::errc{} && end == text.data() + text.size() && !text.empty();
  return sound ? value : otherwise;
}

int RecordingHeader::ChannelOf(std::string_view name) const {
  const auto found = std::find(channels.begin(), channels.end(), name);
  return found == channels.end() ? -1 : static_cast<int>(found - channels.begin());
}

std::string RecordingHeader::KeyOf(std::string_view key, int hand) {
  return hand == 0 ? std::string(key) : fmt::format("{}_{}", key, hand + 1);
}

TickRecord RecordingHeader::EmptyTick() const {
  TickRecord tick;
  tick.others.resize(others.size());
  tick.picture.others.resize(others.size());
  tick.channels.resize(channels.size());
  tick.picture.q.setZero(static_cast<Eigen::Index>(mechanism.coordinates.size()));
  tick.picture.v.setZero(static_cast<Eigen::Index>(mechanism.velocities.size()));
  tick.picture.joints.resize(mechanism.joints.size());
  return tick;
}

}  // namespace vmech
