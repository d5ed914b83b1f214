#pragma once

#include "vmech/kinematics/closure.h"
#include "vmech/kinematics/kinematic_tree.h"

namespace vmech {

/// The pose of a mechanism nearest to that of a hand (paper eq. 7),
///
///   minimise 1/2 e1' K e1   subject to   e2(q) = 0,
///
/// e1 = [p_H - p_G; log(R_H R_G')] by the penalty iteration of paper eq. (8) in the metric K with a
/// multiplier update after each step, which removes the penalty's bias.
struct HandTarget {
  int node = -1;                          ///< that carries the grasp frame
  Posed X_BG;                             ///< grasp frame in the node
  Posed X_WH;                             ///< the hand
  Vector6d stiffness = Vector6d::Ones();  ///< K, diagonal; zero for rows that a point grasp ignores
};

struct FollowOptions {
  double penalty = 1e4;      ///< lambda^2 over the stiffness; 1e3..1e6, more is stiffer, less exact
  int max_iterations = 200;  ///< 1..10000
  double tolerance = 1e-12;  ///< of the last step and the loop error, dimensionless
};

struct FollowSummary {
  bool converged = false;
  int iterations = 0;
  double closure = 0;        ///< largest loop error, dimensionless
  double hand_distance = 0;  ///< |p_H - p_G| that is left [m]
};

FollowSummary FollowHand(const KinematicTree& tree, const HandTarget& target,
                         const FollowOptions& options, DependentSolver<double>* dependents,
                         TreeWorkspace<double>* ws, VectorXd* q);

/// e1 [6]: displacement and rotation vector from G to H, world axes.
Vector6d HandError(const Posed& X_WG, const Posed& X_WH);

}  // namespace vmech
