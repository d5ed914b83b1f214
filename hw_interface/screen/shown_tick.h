#pragma once

#include <memory>
#include <span>
#include <utility>

#include "vmech/hw_interface/rendering/tick_around.h"
#include "vmech/hw_interface/screen/triple_buffer.h"

namespace vmech {

/// A tick that another thread may look at. It shows itself when the last picture has been taken,
/// and waits for nobody.
class ShownTick : public TickAround {
 public:
  /// `picture` has its sizes, as the tick's Show fills it.
  ShownTick(std::unique_ptr<Tick> tick, const TickPicture& picture)
      : TickAround(std::move(tick)), pictures_(picture) {}

  void StepHands(std::span<const TickInput> inputs, std::span<TickOutput> outputs,
                 std::span<double> channels) noexcept override;

  /// For the other thread.
  TripleBuffer<TickPicture>& pictures() noexcept { return pictures_; }

 private:
  TripleBuffer<TickPicture> pictures_;
};

}  // namespace vmech
