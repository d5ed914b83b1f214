#include "vmech/hw_interface/screen/shown_tick.h"

namespace vmech {

TickOutput ShownTick::Step(const TickInput& input, std::span<double> channels) noexcept {
  const TickOutput output = tick_->Step(input, channels);
  if (pictures_.wanted()) {
    TickPicture& picture = pictures_.back();
    tick_->Show(&picture);
    picture.F_Ho_W = output.F_Ho_W;
    picture.holds = input.held;
    pictures_.Publish();
  }
  return output;
}

}  // namespace vmech
