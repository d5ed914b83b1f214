#pragma once

#include <vector>

#include "vmech/comparison/random.h"
#include "vmech/kinematics/tree/kinematic_tree.h"
#include "vmech/solvers/constrained_least_squares.h"

namespace vmech {

/// The free motions at a closed configuration: an orthonormal basis of the null space of the loop
/// Jacobian [nv, mobility], in radians and characteristic lengths.
MatrixXd FreeMotionBasis(const KinematicTree& tree, const VectorXd& q);

/// A walk over closed configurations within the joint limits, on one branch: small steps along the
/// free motions, each closed again by Assemble. It keeps away from poses where the loops lose rank:
/// there branches meet, and no solver could tell which one is meant.
class ClosedWalk {
 public:
  /// q must be closed; `rank` is that of the loop equations in general (AnalyseMobility). The first
  /// direction is random.
  ClosedWalk(const KinematicTree& tree, const std::vector<Bound>& bounds, int rank, VectorXd q,
             PortableRandom* random);

  /// Goes on by `size`, turning by about `turn` [rad] if there is more than one freedom. Where the
  /// way ahead is barred it takes another. False, and no step, if there is none.
  bool Step(double size, double turn);

  const VectorXd& q() const { return q_; }  ///< [nq], loops closed
  /// The last step, of length 1 [nv]; its sign follows the walk.
  const VectorXd& direction() const { return direction_; }

 private:
  bool TryStep(double size, const VectorXd& wish);
  bool WithinLimits(const VectorXd& q) const;
  bool LoopsKeepRank(const VectorXd& q) const;

  const KinematicTree& tree_;
  const std::vector<Bound>& bounds_;
  int rank_;
  VectorXd scale_;
  VectorXd q_, direction_;
  PortableRandom* random_;
};

}  // namespace vmech
