#pragma once

#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "vmech/hw_interface/rendering/tick.h"

namespace vmech {

/// A tick that adds something to the steps of another, to which it hands everything on.
class TickAround : public Tick {
 public:
  /// Takes the tick that it is put around.
  explicit TickAround(std::unique_ptr<Tick> tick) : tick_(std::move(tick)) {}

  std::vector<std::string> ChannelNames() const override { return tick_->ChannelNames(); }
  std::vector<std::string> StateNames() const override { return tick_->StateNames(); }
  Posed GraspFrame() const noexcept override { return tick_->GraspFrame(); }
  bool GraspAt(const Posed& X_WH) noexcept override { return tick_->GraspAt(X_WH); }
  void Reset() noexcept override { tick_->Reset(); }
  bool UsesObservedHand() const noexcept override { return tick_->UsesObservedHand(); }
  /// One hand's step, by StepHands.
  TickOutput Step(const TickInput& input, std::span<double> channels) noexcept override {
    TickOutput output;
    StepHands({&input, 1}, {&output, 1}, channels);
    return output;
  }
  int hands() const noexcept override { return tick_->hands(); }
  /// The inner tick's.
  Posed HeldFrame(int hand) const noexcept override { return tick_->HeldFrame(hand); }
  /// The inner tick's.
  bool HandGraspsAt(int hand, const Posed& X_WH) noexcept override {
    return tick_->HandGraspsAt(hand, X_WH);
  }
  void StepHands(std::span<const TickInput> inputs, std::span<TickOutput> outputs,
                 std::span<double> channels) noexcept override {
    tick_->StepHands(inputs, outputs, channels);
  }
  void Show(TickPicture* picture) const noexcept override { tick_->Show(picture); }
  std::string FullReport() const override { return tick_->FullReport(); }

 protected:
  Tick* around() const noexcept { return tick_.get(); }  ///< the inner tick

 private:
  std::unique_ptr<Tick> tick_;
};

}  // namespace vmech
