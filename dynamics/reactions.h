#pragma once

#include <vector>

#include "vmech/dynamics/rule.h"
#include "vmech/kinematics/coordinate_partition.h"
#include "vmech/kinematics/envelope_ldlt.h"
#include "vmech/kinematics/tree_workspace.h"

namespace vmech {

/// A joint in one pose. F is the anchor on its first link, M that on its second.
struct JointState {
  Matrix3d R_WF;
  Vector3d p_WM;
  Vector3d n_W;  ///< kUniversal: unit vector across both axes, the one moment that the joint holds
  Wrenchd W_M;   ///< what the first link exerts on the second, about M, world axes
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
void JointFrames(const KinematicTree& tree, const TreeWorkspace<double>& ws,
                 std::vector<JointState>* joints);
/// Wrenches of the tree joints from F_Bo; those of cut joints are left alone.
void TreeJointWrenches(const KinematicTree& tree, const TreeWorkspace<double>& ws,
                       std::vector<JointState>* joints);
/// Adds what the multipliers mu [rows] of the cut joints do to F_Bo all around their loops.
void AddMultiplierWrenches(const KinematicTree& tree, const double* mu, TreeWorkspace<double>* ws);

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
class ReactionSolver {
 public:
  ReactionSolver(const KinematicTree& tree, const CoordinatePartition& partition,
                 std::vector<JointCompliance> compliances);

  /// Needs LoopJacobian in ws and JointFrames; factors the matrix above.
  void Factor(const TreeWorkspace<double>& ws, const std::vector<JointState>& joints);
  /// `joints` carry the wrenches W_j0 without multipliers; r [nv] is read at the dependent entries.
  /// Writes mu [rows].
  void Solve(const TreeWorkspace<double>& ws, const std::vector<JointState>& joints,
             const double* r, double* mu);

 private:
  /// A loop that loads a joint, and the sense in which mu enters W_M.
  struct Load {
    int loop;
    double sign;
  };
  /// Two loops that load a joint in common, l <= k; their share of A in world axes, [f; m].
  struct Block {
    int k, l;
    Matrix6d A_W;
  };
  /// Joint j feeds blocks_[block] through its loads number k and l.
  struct Contribution {
    int joint, load_k, load_l, block;
  };

  void FindLoads();
  void OrderUnknowns();
  int BlockIndex(int k, int l);
  void AddBlockToMatrix(const TreeWorkspace<double>& ws, const Block& block);
  void AddJacobianToMatrix(const TreeWorkspace<double>& ws);

  const KinematicTree& tree_;
  const CoordinatePartition& partition_;
  std::vector<JointCompliance> compliances_;
  std::vector<std::vector<Load>> loads_;  ///< per joint
  std::vector<Block> blocks_;
  std::vector<Contribution> contributions_;
  std::vector<int> row_position_;        ///< per loop: place of its first row among the unknowns
  std::vector<int> dependent_position_;  ///< per dependent velocity
  std::vector<Matrix3d> soft_force_W_, soft_moment_W_;  ///< D_j, world axes
  std::vector<Wrenchd> strain_W_;                       ///< per loop: b before projection
  std::vector<double> unknowns_;
  EnvelopeLdlt matrix_;
};

}  // namespace vmech
