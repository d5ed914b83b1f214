#pragma once

#include "vmech/dynamics/in_hand/coupled_dynamics.h"

namespace vmech {

/// A hand that closes on a link, which may move fast. What it can hold grows from nothing at a
/// steady rate, F = R t and M = l R t; a link that pulls more slips through it: the grasp frame
/// slides along the link, and hand and link feel the same friction. So the force on the hand
/// changes by no more than R T from one tick to the next, the coupling gains no energy, and a hand
/// that has taken hold stays where it came to rest on the link.
///
/// With e the stretch of the coupling at the end of the step, should the link go on as it does,
///
///   p = K e + B (V_H - V),   e = e1 - T V,   V = V_G + its change in the last step,
///
/// and s = min(1, F/|p|) of forces and moments each, the frame slides by (1 - s) e and the coupling
/// is told of a hand that asks it for s p.
class ClosingHand {
 public:
  /// `coupling` as at the mechanism. `rate`: R, likewise [N/s]. `step`: T [s].
  ClosingHand(const HandCoupling& coupling, double rate, double step);

  /// Opens: the next Step is the first of a new grasp.
  void Open() noexcept;
  /// Has closed: holds as the coupling does.
  void Hold() noexcept { hold_ = full_; }
  /// False once it holds what the coupling can pull.
  bool closing() const noexcept { return hold_ < full_; }
  /// Before a step of the mechanism with this hand of it at X_WH, moving with V_WH: slides the
  /// grasp frame and sets the hand. In the first step nothing pulls yet.
  void BeforeStep(const Posed& X_WH, const Vector6d& V_WH, int hand,
                  CoupledDynamics* dynamics) noexcept;
  /// After that step: finds what it holds in the next.
  void AfterStep(CoupledStatus status, int hand, CoupledDynamics* dynamics) noexcept;

  /// Largest force that it holds in the next step [N].
  double hold() const noexcept { return hold_; }

 private:
  void Foresee(const Vector6d& change) noexcept;

  HandCoupling coupling_;
  double rate_, step_, full_;
  double hold_ = 0;                     // F now [N]
  Vector6d V_WG_ = Vector6d::Zero();    // before the step
  Vector6d change_ = Vector6d::Zero();  // of V_WG in the last step
};

}  // namespace vmech
