#pragma once

#include <vector>

#include "vmech/base/linear_algebra/envelope_ldlt.h"
#include "vmech/dynamics/reactions/loop_loads.h"
#include "vmech/dynamics/reactions/rule.h"
#include "vmech/kinematics/loops/coordinate_partition.h"
#include "vmech/kinematics/tree/tree_workspace.h"

namespace vmech {

/// A joint in one pose (T: double, or Packet for four). F is the anchor on its first link, M that
/// on its second.
template <typename T>
struct JointState {
  Matrix3<T> R_WF;
  Vector3<T> p_WM;
  Vector3<T> n_W;  ///< kUniversal: unit vector across both axes, the one moment that it holds
  Wrench<T> W_M;   ///< what the first link exerts on the second, about M, world axes
};

/// How soft a joint is against the force and moment that it holds, axes of F [m/N], [rad/(N m)];
/// zero along its freedoms, which hold nothing. A universal joint is soft about the direction that
/// is neither of its axes; that is its z entry.
struct JointCompliance {
  Vector3d force = Vector3d::Zero();
  Vector3d moment = Vector3d::Zero();
};

/// Compliances for a rule. `stiffness` takes 1/Joint::stiffness; where a joint gives none, and for
/// `minimum_norm` in every joint, 1/kDefaultStiffness and 1/(kDefaultStiffness length^2).
std::vector<JointCompliance> CompliancesForRule(const KinematicTree& tree, ReactionRule rule,
                                                double length);
inline constexpr double kDefaultStiffness = 1e8;  ///< [N/m], of a medium-sized ball bearing

/// Frames of all joints. Needs X_WB; writes R_WF, p_WM and n_W.
template <typename T>
void JointFrames(const KinematicTree& tree, const TreeWorkspace<T>& ws,
                 std::vector<JointState<T>>* joints);
/// Wrenches of the tree joints from F_Bo; those of cut joints are left alone.
template <typename T>
void TreeJointWrenches(const KinematicTree& tree, const TreeWorkspace<T>& ws,
                       std::vector<JointState<T>>* joints);
/// Adds what the multipliers mu [rows] of the cut joints do to F_Bo all around their loops.
template <typename T>
void AddMultiplierWrenches(const KinematicTree& tree, const T* mu, TreeWorkspace<T>* ws);

/// The multipliers of the cut joints. Equilibrium of the dependent freedoms, C_u' mu = r (paper eq.
/// 13), leaves as many of them open as there are redundant equations; these follow from the least
/// elastic energy of all joints, cut or not, whose wrenches are linear in mu:
///
///   minimise 1/2 sum_j W_j' D_j W_j,  W_j = W_j0 + T_j mu   subject to  C_u' mu = r,
///
///   [ A    C_u ] [ mu ]   [ -b ]      A = sum_j T_j' D_j T_j
///   [ C_u'  0  ] [ -x ] = [  r ],     b = sum_j T_j' D_j W_j0.
///
/// Unknowns are ordered loop by loop, each dependent freedom behind the last loop that it moves, so
/// that no pivot vanishes while the loops determine the dependent freedoms. The answer does not
/// depend on where the loops are cut.
template <typename T>
class ReactionSolver {
 public:
  ReactionSolver(const KinematicTree& tree, const CoordinatePartition& partition,
                 std::vector<JointCompliance> compliances);

  /// Needs LoopJacobian in ws and JointFrames; factors the matrix above.
  void Factor(const TreeWorkspace<T>& ws, const std::vector<JointState<T>>& joints);
  /// `joints` carry the wrenches W_j0 without multipliers; r [nv] is read at the dependent entries.
  /// Writes mu [rows].
  void Solve(const TreeWorkspace<T>& ws, const std::vector<JointState<T>>& joints, const T* r,
             T* mu);

 private:
  /// Two loops that load a joint in common, l <= k; their share of A in world axes, by forces and
  /// moments. Symmetric where k = l: A_mf is not used there.
  struct Block {
    int k, l;
    Matrix3<T> A_ff, A_fm, A_mf, A_mm;
  };
  /// Joint j feeds blocks_[block] through its loads number k and l.
  struct Contribution {
    int joint, load_k, load_l, block;
  };

  void FindLoads();
  void OrderUnknowns();
  int BlockIndex(int k, int l);
  void AddContribution(const TreeWorkspace<T>& ws, const std::vector<JointState<T>>& joints,
                       const Contribution& contribution);
  double IsotropicMoment(int joint) const;
  void AddBlockToMatrix(const TreeWorkspace<T>& ws, const Block& block);
  void AddJacobianToMatrix(const TreeWorkspace<T>& ws);

  const KinematicTree& tree_;
  const CoordinatePartition& partition_;
  std::vector<JointCompliance> compliances_;
  std::vector<std::vector<LoopLoad>> loads_;  ///< per joint
  std::vector<Block> blocks_;
  std::vector<Contribution> contributions_;
  std::vector<int> row_position_;        ///< per loop: place of its first row among the unknowns
  std::vector<int> dependent_position_;  ///< per dependent velocity
  std::vector<Wrench<T>> strain_W_;      ///< per loop: b before projection
  std::vector<T> unknowns_;
  EnvelopeLdlt<T> matrix_;
};

}  // namespace vmech
