#pragma once

#include <memory>

#include "vmech/hw_interface/audit/felt_report.h"
#include "vmech/hw_interface/audit/recorded_tree.h"
#include "vmech/hw_interface/recording/tick_listener.h"

namespace vmech {

/// Fits what a hand felt in a session to how it moved, by least squares in memory that does not
/// grow: along the free motions, whose basis is N, and against the constraints,
///
///   P'J'(-F)/s = a S P'(M v' + c) + g P'h + b P'J'D J v + P'tau_p,    v = P V_H,
///   (1 - P'J')(-F) = k K e1 + r e1',        P = N (N'J'K J N)^-1 N'J'K,
///
/// F what the device exerted on the hand, V_H the hand's twist, v' by differences, M v' + c and h
/// the mechanism's inertia and weight, tau_p springs and friction of its joints, e1 from grasp to
/// hand, s the scale, S the share of the inertia that the paper's way renders at the pose, else 1.
/// Both sides go through the same low-pass filter of 3 Hz, below which inertia is promised, so that
/// what they have in common is not changed by it. P comes from the recorded pose. Left out is what
/// says nothing of the mechanism: the soft start, ticks whose force was withheld by more than 2 %,
/// and those whose wrench is that of a slipping coupling, a stop or a bound (OwnWrench). Where both
/// sides are noisy, a figure counts as uncertain by as much as the fit of its own term to the rest
/// would differ. Calibrated wrenches are needed: where the device does not sense what it exerts, it
/// is taken to do what it is told.
class FeltFit : public TickListener {
 public:
  /// Keeps a reference to the mechanism.
  FeltFit(const RecordingHeader& header, const RecordedTree& held);
  ~FeltFit() override;

  void Take(const TickRecord& tick) override;  ///< the next tick of the session
  FeltReport Report() const;                   ///< on all ticks so far

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace vmech
