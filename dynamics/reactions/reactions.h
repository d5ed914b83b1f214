#pragma once

#include <vector>

#include "vmech/base/linear_algebra/envelope_ldlt.h"
#include "vmech/dynamics/reactions/joint_wrenches.h"
#include "vmech/dynamics/reactions/loop_loads.h"
#include "vmech/dynamics/reactions/rule.h"
#include "vmech/kinematics/loops/coordinate_partition.h"

namespace vmech {

/// How soft a joint is against the force and moment that it holds, axes of F [m/N], [rad/(N m)];
/// zero along its freedoms, which hold nothing. A universal joint is soft about the direction that
/// is neither of its axes; that is its z entry.
struct JointCompliance {
  Vector3d force = Vector3d::Zero();   ///< [m/N]
  Vector3d moment = Vector3d::Zero();  ///< [rad/(N m)]
};

/// Compliances for a rule. `stiffness` takes the inverses of a joint's stiffness; where a joint
/// gives none, and for `minimum_norm` in every joint, 1/kDefaultStiffness and
/// 1/(kDefaultStiffness length^2).
std::vector<JointCompliance> CompliancesForRule(const KinematicTree& tree, ReactionRule rule,
                                                double length);
inline constexpr double kDefaultStiffness = 1e8;  ///< [N/m], of a medium-sized ball bearing

/// The multipliers of the cut joints. Equilibrium of the dependent freedoms, C_u' mu = r (paper eq.
/// 13), leaves as many of them open as there are redundant equations; these follow from the least
/// elastic energy of all joints, cut or not, whose wrenches are linear in mu:
///
///   minimise 1/2 sum_j W_j' D_j W_j,  W_j = W_j0 + T_j mu   subject to  C_u' mu = r,
///
///   [ A    C_u ] [ mu ]   [ -b ]      A = sum_j T_j' D_j T_j
///   [ C_u'  0  ] [ -x ] = [  r ],     b = sum_j T_j' D_j W_j0.
///
/// A column of T_j is what a unit multiplier puts on joint j: +- LoopState::wrench, seen in the
/// joint's frame. Unknowns are ordered loop by loop, each dependent freedom behind the last loop
/// that it moves, so that no pivot vanishes while the loops determine the dependent freedoms. The
/// answer does not depend on where the loops are cut.
template <typename T>
class ReactionSolver {
 public:
  /// Keeps references; `compliances` per joint.
  ReactionSolver(const KinematicTree& tree, const CoordinatePartition& partition,
                 const std::vector<JointCompliance>& compliances);

  /// Needs LoopJacobian in ws and JointFrames; factors the matrix above.
  void Factor(const TreeWorkspace<T>& ws, const std::vector<JointState<T>>& joints);
  /// `joints` carry the wrenches W_j0 without multipliers; r [nv] is read at the dependent entries.
  /// Writes mu [rows].
  void Solve(const std::vector<JointState<T>>& joints, const T* r, T* mu);

 private:
  void OrderUnknowns();
  void AddToMatrix(const Vector6<T>* columns, const std::vector<LoopLoad>& loads);
  void AddJacobianToMatrix(const TreeWorkspace<T>& ws);
  /// D^1/2 W in the joint's frame.
  Vector6<T> Strain(size_t joint, const JointState<T>& state, const ScrewT<T>& W) const;

  const KinematicTree& tree_;
  const CoordinatePartition& partition_;
  std::vector<Vector6d> root_compliances_;    ///< D^1/2 per joint
  std::vector<std::vector<LoopLoad>> loads_;  ///< per joint
  std::vector<int> row_position_;        ///< per loop: place of its first row among the unknowns
  std::vector<int> dependent_position_;  ///< per dependent velocity
  std::vector<Vector6<T>> columns_;      ///< of D^1/2 T, joint by joint and load by load
  std::vector<T> unknowns_;
  EnvelopeLdlt<T> matrix_;
};

}  // namespace vmech
