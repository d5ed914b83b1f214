#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include "vmech/base/triple_buffer.h"
#include "vmech/hw_interface/rendering/coupled_tick.h"
#include "vmech/hw_interface/rendering/tick_around.h"
#include "vmech/hw_interface/variation/design_path.h"

namespace vmech {

/// A mechanism that another thread changes while hands hold it. Before each step it goes a little
/// towards the newest design that was sent; what a hand feels changes by kMostForce at most, and
/// waits for nobody. The work of the changes is a port of its own beside the hands: it is measured,
/// told, and no part of what a hand may get back.
class VariedTick : public TickAround {
 public:
  static constexpr double kMostForce = 0.5;    ///< a step [N], at the hand
  static constexpr double kMostMoment = 0.05;  ///< the same [N m]

  /// A design on its way to the tick, numbered from 1 on.
  struct Sent {
    std::uint64_t number = 0;  ///< from 1, the newest is the largest
    HeldDesign design;         ///< with the numbers of all links and joints
  };

  /// `start`: the design that the tick has, with a grasp for each hand.
  VariedTick(std::unique_ptr<CoupledTick> tick, const HeldDesign& start);

  void StepHands(std::span<const TickInput> inputs, std::span<TickOutput> outputs,
                 std::span<double> channels) noexcept override;
  /// And the design.
  void Show(TickPicture* picture) const noexcept override;
  std::string FullReport() const override;
  /// Has a design been sent to it?
  bool varied() const noexcept { return number_ > 0; }

  /// For the other thread, which writes.
  TripleBuffer<Sent>& designs() noexcept { return designs_; }

 private:
  CoupledTick* tick_;
  DesignPath path_;
  TripleBuffer<Sent> designs_;
  std::uint64_t number_ = 0;
};

}  // namespace vmech
