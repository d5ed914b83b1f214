#pragma once

#include "vmech/dynamics/in_hand/coupled_dynamics.h"
#include "vmech/dynamics/in_hand/held_design.h"

namespace vmech {

/// A mechanism on the way from one design to another, while it is held: a little at each step, as
/// much as the couplings bear. Where the loops do not close any further it stops. No allocation
/// after construction.
class DesignPath {
 public:
  /// All designs have the sizes of this one, which the mechanism has.
  explicit DesignPath(const HeldDesign& start)
      : from_(start), to_(start), now_(start), next_(now_) {}

  /// Sets out for another design, straight from where it is.
  void GoTo(const HeldDesign& to) noexcept;
  /// One step, by `change(from, to)`, a DesignStatus. True if the mechanism has changed.
  template <typename Change>
  bool Advance(const Change& change) noexcept;

  const HeldDesign& now() const noexcept { return now_; }  ///< what the mechanism has
  bool arrived() const noexcept { return share_ >= 1; }    ///< at the design that it goes to
  /// The loops do not close where it would go on, at this pose.
  bool stopped() const noexcept { return stopped_; }
  bool moves() const noexcept { return !arrived() && !stopped_; }  ///< it is under way

 private:
  static constexpr double kLongest = 0.02;   // step, of a way: fifty take the way to its end
  static constexpr double kFirst = 1e-4;     // step
  static constexpr double kShortest = 1e-7;  // step
  static constexpr double kGrowth = 1.25;    // from step to step
  static constexpr double kPatience = 1e-5;  // step with which loops have to close

  HeldDesign from_, to_, now_, next_;
  double share_ = 1, step_ = kFirst;
  bool stopped_ = false;
};

template <typename Change>
bool DesignPath::Advance(const Change& change) noexcept {
  if (!moves()) return false;
  const double share = share_ + step_ < 1 ? share_ + step_ : 1;
  if (share < 1) {
    Blend(from_, to_, share, &next_);
  } else {
    next_ = to_;
  }
  const DesignStatus status = change(now_, next_);
  if (status != DesignStatus::kTaken) {
    step_ /= 2;
    stopped_ = step_ < (status == DesignStatus::kOpen ? kPatience : kShortest);
    return false;
  }
  now_ = next_;
  share_ = share;
  step_ = step_ * kGrowth < kLongest ? step_ * kGrowth : kLongest;
  return true;
}

}  // namespace vmech
