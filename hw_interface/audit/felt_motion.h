#pragma once

#include "vmech/hw_interface/audit/promise.h"

namespace vmech {

/// The motion of the inertia that is felt in the paper's way, as a recording tells it: with the
/// velocities v of the pose and the share s of inertia,
///
///   u' = (v - u) / t,   s^1/2 u and s^1/2 (s^1/2 u)'          (MechanismTick).
class FeltMotion {
 public:
  explicit FeltMotion(const RecordingHeader& header);  ///< takes period, roll-off and share

  /// The next tick that a hand had the mechanism.
  void Take(const TickRecord& tick);
  const VectorXd& velocity() const { return felt_; }  ///< s^1/2 u [nv]
  const VectorXd& rate() const { return rate_; }      ///< s^1/2 times its rate [nv]
  /// False where accelerations come of an estimator that the recording does not hold.
  bool knows_rate() const { return knows_rate_; }

 private:
  double period_, roll_off_, share_;
  int share_channel_;
  bool knows_rate_;
  MasterState last_;
  bool started_ = false;
  double root_ = 0;
  VectorXd u_, felt_, rate_;
};

/// Is the wrench of a tick the mechanism's own? It is not where a coupling slips, a joint stands at
/// its limit or a motion was stopped; in the paper's way where the pose is held, or forces are kept
/// within bounds.
class OwnWrench {
 public:
  explicit OwnWrench(const RecordingHeader& header);  ///< takes where its channels are
  /// Up to `tolerance`, a share of the force.
  bool IsIn(const TickRecord& tick, double tolerance) const;
  /// And is the pose the nearest to the hand, in the paper's way?
  bool IsOfNearestPose(const TickRecord& tick, double tolerance) const;

 private:
  double StateOf(const TickRecord& tick) const;

  bool paper_;
  int state_channel_, force_channel_;
};

}  // namespace vmech
