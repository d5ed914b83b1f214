#include "vmech/hw_interface/variation/varied_tick.h"

#include <fmt/format.h>

#include <utility>

namespace vmech {

VariedTick::VariedTick(std::unique_ptr<CoupledTick> tick, const HeldDesign& start)
    : TickAround(std::move(tick)),
      tick_(static_cast<CoupledTick*>(around())),
      path_(start),
      designs_({0, start}) {}

void VariedTick::StepHands(std::span<const TickInput> inputs, std::span<TickOutput> outputs,
                           std::span<double> channels) noexcept {
  if (designs_.Take()) {
    number_ = designs_.front().number;
    path_.GoTo(designs_.front().design);
  }
  path_.Advance([this](const HeldDesign& from, const HeldDesign& to) noexcept {
    return tick_->ChangeDesign(from, to, {kMostForce, kMostMoment});
  });
  tick_->StepHands(inputs, outputs, channels);
}

void VariedTick::Show(TickPicture* picture) const noexcept {
  tick_->Show(picture);
  picture->design = path_.now().values;
  picture->design_number = number_;
  picture->design_arrived = path_.arrived();
  picture->design_stopped = path_.stopped();
  picture->design_work = tick_->dynamics().design_work();
}

std::string VariedTick::FullReport() const {
  std::string report = tick_->FullReport();
  if (!varied()) return report;
  return report +
         fmt::format(
             "  its design was changed, which has raised its energy by {:.3g} J; what was felt is "
             "of no one mechanism\n",
             tick_->dynamics().design_work());
}

}  // namespace vmech
