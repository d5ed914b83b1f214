#pragma once

#include <vector>

#include "vmech/kinematics/inverse/inverse_kinematics.h"
#include "vmech/kinematics/motion/motion_law.h"

namespace vmech {

/// The one freedom of a mechanism as a track for a hand: s is the way of the grasp frame from the
/// pose q, its turn counted with a lever of 0.1 m.
class FreeMotion {
 public:
  /// As far as `reach` [m] to both sides. Aborts if the mechanism stops before.
  FreeMotion(const KinematicTree& tree, const GraspFrame& grasp, const VectorXd& q, double reach);

  /// The grasp frame at s [m], and its derivatives by s.
  HandSample At(double s) const { return track_.At(s); }
  /// What the mechanism resists a motion s(t) with, without weight: m s'' + m'(s) s'^2 / 2, m the
  /// inertia dq/ds' M dq/ds [kg].
  double InertiaForce(double s, double rate, double acceleration) const;

 private:
  HandLaw track_ = HandLaw::Table({0}, {Posed{}});
  MotionLaw inertia_ = MotionLaw::Uniform(0, 0);
};

/// Basis of the velocities that the loops allow at q, which may come from any closed pose.
MatrixXd FreeVelocities(const KinematicTree& tree, const VectorXd& q);

}  // namespace vmech
