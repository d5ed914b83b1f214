#pragma once

#include "vmech/kinematics/inverse/inverse_kinematics.h"
#include "vmech/kinematics/loops/dimensionless_loops.h"

namespace vmech {

/// Motions that neither the hand nor the loops see: the null space of A = [J; C], J that of the
/// hand's error. A rod between two ball joints spins while a crank is held, the elbow of an arm
/// with seven axes circles while its flange is held. Poses that differ by such a motion alone are
/// the same as far as hand and loops go, on the same branch.
struct UnseenMotions {
  /// At one pose: radians and characteristic lengths per unit, orthonormal [nv, count]. At a
  /// singular pose, where more motions are unseen for a moment, those that neighbours have too.
  MatrixXd basis;

  int count() const { return static_cast<int>(basis.cols()); }  ///< 0: everything is seen
};

/// Those of a grasp at q, a closed pose. Rank is judged at q and, where something is unseen there,
/// at closed poses nearby, since a dead centre hides a motion at one pose alone. A pivot below
/// kRankTolerance counts as zero.
UnseenMotions FindUnseenMotions(InverseKinematics* problem, const VectorXd& q);

/// Moves the closed pose q along its unseen motions, hand and loops as they are, to where it is
/// nearest to `goal` (ConfigurationDistance). The way downhill is taken; where that ends farther
/// from the goal than `enough`, the whole way of each motion is searched, one after the other.
/// Without any, q is returned. Joint limits are not looked at.
VectorXd NearestAlongUnseen(InverseKinematics* problem, const VectorXd& q, const VectorXd& goal,
                            double enough = 1e-4);

}  // namespace vmech
