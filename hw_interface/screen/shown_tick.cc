#include "vmech/hw_interface/screen/shown_tick.h"

namespace vmech {

void ShownTick::StepHands(std::span<const TickInput> inputs, std::span<TickOutput> outputs,
                          std::span<double> channels) noexcept {
  TickAround::StepHands(inputs, outputs, channels);
  if (!pictures_.wanted()) return;
  TickPicture& picture = pictures_.back();
  Show(&picture);
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    HandPicture& hand = picture.hand(static_cast<int>(i));
    hand.F_Ho_W = outputs[i].F_Ho_W;
    hand.holds = inputs[i].held;
  }
  pictures_.Publish();
}

}  // namespace vmech
