#pragma once

#include <vector>

#include "vmech/kinematics/loops/coordinate_partition.h"
#include "vmech/kinematics/tree/tree_workspace.h"

namespace vmech {

/// What equilibrium leaves open at one closed pose: the multipliers mu with C_u' mu = 0, C_u [rows,
/// dependent] being the dimensionless loop Jacobian of the dependent velocities. Householder
/// reflections bring C_u to [R; 0] loop by loop: in its turn a loop takes up its own rows and those
/// that the loops before it have left over, eliminates the velocities that move no later loop, and
/// hands on a row for each velocity that does. Rows without a velocity are open. A loop's turn
/// knows its own part of all this only, so that time and memory are linear in the number of loops
/// where each has to do with a few neighbours.
class OpenReactions {
 public:
  /// Needs LoopJacobian in ws.
  OpenReactions(const KinematicTree& tree, const CoordinatePartition& partition,
                const TreeWorkspace<double>& ws);

  /// The part of a matrix T [n, rows] that belongs to the multipliers of one loop.
  struct Block {
    size_t loop;  ///< index in KinematicTree::loops
    MatrixXd T;   ///< [n, rows of the loop]
  };
  /// For each row t of T, which is zero but for its blocks, these in the order of their loops: how
  /// much t' mu can be for open multipliers of unit length [n]. It is |Z' t|, the columns of Z an
  /// orthonormal basis of them.
  VectorXd LargestOpen(const std::vector<Block>& blocks) const;

  /// The least singular value of C_u, by a few steps of inverse iteration, which are above it and
  /// the closer the smaller it is; over a bound of the largest, sqrt(|C_u|_1 |C_u|_inf). It is 1
  /// where no velocity is dependent.
  double LeastSingularValue() const;

 private:
  /// Rows of a matrix of which some columns are not zero.
  struct Rows {
    std::vector<int> slots;  ///< the columns, as places of velocities among the dependent ones
    MatrixXd A;              ///< [rows, slots]
  };
  /// A loop's turn: Q' [rows handed to it; its own] = [R; rows handed on; open rows].
  struct Turn {
    Eigen::Index handed = 0;
    std::vector<int> eliminated, later;  ///< slots of the velocities that end here, and of others
    MatrixXd R, R_later;                 ///< [eliminated, eliminated] and [eliminated, later]
    MatrixXd Q;                          ///< [rows, rows]
    Eigen::Index handed_on = 0;
    /// What rows handed on load with values x of the open rows of all later turns is |ahead x|.
    MatrixXd ahead;
  };

  Rows TakeTurn(const Rows& handed, const Rows& own, size_t loop);
  void LookAhead();
  VectorXd SolveTransposed(VectorXd b) const;
  VectorXd Solve(VectorXd b) const;

  std::vector<int> last_loop_;  ///< that a dependent velocity moves, by slot
  double norm_ = 0;             ///< the bound
  bool has_full_rank_ = true;   ///< as far as the places of its entries say
  std::vector<Turn> turns_;     ///< per loop
};

}  // namespace vmech
