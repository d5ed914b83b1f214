#pragma once

#include "vmech/hw_interface/audit/audit_report.h"
#include "vmech/hw_interface/audit/audited_pose.h"

namespace vmech {

/// What happened to a mechanism between two ticks, beside its poses.
struct TracedStep {
  double hand = 0;        ///< work of all hands [J]
  double throughput = 0;  ///< the sum of its sizes [J]
  double joints = 0;      ///< given to springs, friction and limits, in the virtual coupling [J]
  // In the virtual coupling:
  /// The mechanism paid what no hand gave out of its velocities; by how much is not recorded.
  bool paid = false;
  double corrected = 0;   ///< work of what closes the loops [J]
  double moved = 0;       ///< all forces times the ways of the step, of whatever direction [J]
  double constraint = 0;  ///< work of the constraints [J]
  /// In the paper's way: the wrench is that of the motion and the pose is the nearest, at both
  /// ends.
  bool faithful = true;
};

/// Keeps the account of a recorded mechanism's energy.
class EnergyTrace {
 public:
  /// Keeps a reference to the tree. `period`: of the loop [s]. `follows`: the mechanism follows the
  /// hand, in the paper's way; then poses are accelerated.
  EnergyTrace(const KinematicTree& tree, double period, bool follows);

  void Begin(const AuditedPose& now);  ///< the hand takes hold
  /// From a tick to the next.
  void Add(const AuditedPose& before, const AuditedPose& now, const TracedStep& step);
  const EnergyBalance& balance() const { return balance_; }  ///< until now

 private:
  void AddFollowed(const AuditedPose& before, const AuditedPose& now, const TracedStep& step);
  void AddStepped(const AuditedPose& before, const AuditedPose& now, const TracedStep& step);

  const KinematicTree& tree_;
  double period_;
  double first_kinetic_ = 0, first_weight_ = 0;
  double inertial_ = 0;  // work on the inertia [J]
  VectorXd way_, last_way_;
  EnergyBalance balance_;
};

}  // namespace vmech
