#pragma once

#include <memory>
#include <string>
#include <vector>

#include "vmech/hw_interface/rendering/tick.h"
#include "vmech/hw_interface/screen/triple_buffer.h"

namespace vmech {

/// A tick that another thread may look at. It shows itself when the last picture has been taken,
/// and waits for nobody.
class ShownTick : public Tick {
 public:
  /// `picture` has its sizes, as the tick's Show fills it.
  ShownTick(std::unique_ptr<Tick> tick, const TickPicture& picture)
      : tick_(std::move(tick)), pictures_(picture) {}

  std::vector<std::string> ChannelNames() const override { return tick_->ChannelNames(); }
  std::vector<std::string> StateNames() const override { return tick_->StateNames(); }
  Posed GraspFrame() const noexcept override { return tick_->GraspFrame(); }
  bool GraspAt(const Posed& X_WH) noexcept override { return tick_->GraspAt(X_WH); }
  void Reset() noexcept override { tick_->Reset(); }
  bool UsesObservedHand() const noexcept override { return tick_->UsesObservedHand(); }
  TickOutput Step(const TickInput& input, std::span<double> channels) noexcept override;
  int hands() const noexcept override { return tick_->hands(); }
  Posed HeldFrame(int hand) const noexcept override { return tick_->HeldFrame(hand); }
  bool HandGraspsAt(int hand, const Posed& X_WH) noexcept override {
    return tick_->HandGraspsAt(hand, X_WH);
  }
  void StepHands(std::span<const TickInput> inputs, std::span<TickOutput> outputs,
                 std::span<double> channels) noexcept override;
  void Show(TickPicture* picture) const noexcept override { tick_->Show(picture); }
  std::string FullReport() const override { return tick_->FullReport(); }

  /// For the other thread.
  TripleBuffer<TickPicture>& pictures() noexcept { return pictures_; }

 private:
  std::unique_ptr<Tick> tick_;
  TripleBuffer<TickPicture> pictures_;
};

}  // namespace vmech
