#pragma once

#include <vector>

#include "vmech/base/linear_algebra/linear_algebra.h"
#include "vmech/kinematics/loops/dimensionless_loops.h"
#include "vmech/kinematics/tree/kinematic_tree.h"
#include "vmech/kinematics/tree/tree_workspace.h"

namespace vmech {

/// What a mechanism can do whose figures are rounded: its loops close nowhere, or at single poses,
/// and the pivots of its dimensionless C that ought to be zero are of the size of the rounding.

/// The dimensionless loop equations at a pose, C dq = e.
struct LoopEquations {
  VectorXd e;   ///< [rows]
  RankSplit C;  ///< [rows, nv] and what is left of it
};

/// A closed pose, as far as its loops close.
struct WalkedPose {
  VectorXd q;         ///< [nq]
  int rank = 0;       ///< of C there
  double misfit = 0;  ///< loop error that no step removes [-]
};

/// Closes loops by least squares over all rows; pivots below a tolerance count as zero.
class LoopCloser {
 public:
  LoopCloser(const KinematicTree& tree, double tolerance);  ///< keeps a reference to the tree

  LoopEquations At(const VectorXd& q);  ///< at a pose, open or closed
  /// Moves *pose to where no step closes its loops any more, and writes its rank and misfit. False
  /// if it has to go far for that, or the misfit is larger than the given one.
  bool Close(double largest_misfit, WalkedPose* pose);
  /// Moves q [nq] by a dimensionless dq [nv].
  void Move(const VectorXd& dq, VectorXd* q) const;

 private:
  const KinematicTree& tree_;
  double tolerance_;
  TreeWorkspace<double> ws_;
  VectorXd row_scale_;
};

/// What a mechanism can do if pivots below `tolerance` are rounding.
struct Walk {
  double tolerance = 0;           ///< pivots below it count as zero
  int rank = 0;                   ///< of C at every pose of the walk
  size_t mobile_clusters = 0;     ///< parts that move, each by itself
  double misfit = 0;              ///< largest on the way
  std::vector<WalkedPose> poses;  ///< of that rank, the start first
  bool stuck = false;             ///< it could not leave a start that it should be able to leave
  /// The misfit explains no pivot that counts.
  bool consistent() const {
    constexpr double kRoundingOverMisfit = 4;
    return !poses.empty() && !stuck && kRoundingOverMisfit * misfit <= tolerance;
  }
};

/// Steps along every free motion of q, to both sides, `poses` of them or so. Of the tolerances from
/// kRankTolerance up, the least that lets as many loops move as any does and whose pivots are well
/// above the misfits on the way. No poses if there is none.
Walk FindWalk(const KinematicTree& tree, const VectorXd& q, double largest_misfit, int poses);

/// True if at the closed pose q some joints around every loop can move: pivots below kRankTolerance
/// count as zero, as in FindNullSpace.
bool EveryLoopMoves(const KinematicTree& tree, const VectorXd& q);

}  // namespace vmech
