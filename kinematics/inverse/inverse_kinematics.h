#pragma once

#include <vector>

#include "vmech/base/rotation_error.h"
#include "vmech/kinematics/tree/grasp_frame.h"
#include "vmech/kinematics/tree/tree_workspace.h"
#include "vmech/solvers/constrained_least_squares.h"

namespace vmech {

/// What the hand's error is measured by, and whether limits hold.
struct InverseKinematicsOptions {
  RotationError rotation_error = RotationError::kLogarithm;  ///< the angle, or the paper's sine
  /// K, diagonal, along and about the world's axes [N/m, N m/rad], each >= 0. It weighs metres
  /// against radians and makes K e1 the wrench of the hand; a zero leaves that row out. All zero,
  /// the default, stands for 1 N/m and L^2 N m/rad, L the characteristic length.
  Vector6d stiffness = Vector6d::Zero();
  /// Joint limits become bounds.
  bool joint_limits = true;

  /// @throws std::invalid_argument naming the field, its value and its range.
  void Validate() const;
};

/// The pose of a mechanism nearest to that of a hand (paper eq. 7),
///
///   minimise 1/2 e1' K e1   subject to   e2(q) = 0,   q_min <= q <= q_max
///
/// as a problem for any solver. e1 = [p_H - p_G; rotation from G to H], world axes, leads from the
/// mechanism to the hand; e2 is that of LoopErrors, all loops. x are the coordinates of the tree
/// and a step dx is a velocity: Plus is MoveCoordinates. What solvers see is dimensionless, with
/// the characteristic length L and the energy E = k L^2, k the mean of the stiffnesses that are not
/// zero (of the positions, or of the rotations over L^2 if the positions have none):
///
///   r = (K/E)^(1/2) e1      J = dr/dv, exact; -(K/E)^(1/2) J_grasp for the positional rows
///   c = W e2                C = W de2/dv = -W C of LoopJacobian where the loops are closed
///
/// W = 1/L for lengths, 1 for rotations. Signs: the paper's C is -de2/dv, ours +. The solvers'
/// J'r + C'mu = 0 then says that J_grasp' K e1 + C_paper' (E W mu) = 0: the spring's pull K e1 on
/// the grasp is balanced by E W mu, which the first link of each cut joint exerts on the second.
///
/// All derivatives are exact at open loops too, second ones included. Evaluate, Plus and Curvature
/// do not allocate.
class InverseKinematics final : public ConstrainedLeastSquares {
 public:
  /// Keeps a reference to the tree.
  /// @throws std::invalid_argument as InverseKinematicsOptions::Validate, or if no row is left by
  ///         the stiffness.
  InverseKinematics(const KinematicTree& tree, const GraspFrame& grasp,
                    const InverseKinematicsOptions& options = {});

  /// The pose of the hand; the identity to begin with.
  void SetTarget(const Posed& X_WH) noexcept { X_WH_ = X_WH; }
  const Posed& target() const { return X_WH_; }  ///< X_WH of the hand

  void Evaluate(const VectorXd& q, VectorXd* r, MatrixXd* J, VectorXd* c, MatrixXd* C) override;
  void Plus(const VectorXd& q, const VectorXd& dq, VectorXd* q_plus) const override;
  bool has_second_derivatives() const override { return true; }
  void Curvature(const VectorXd& q, const VectorXd& mu, MatrixXd* S) override;

  const KinematicTree& tree() const { return tree_; }  ///< of the mechanism, its loops cut
  const GraspFrame& grasp() const { return grasp_; }   ///< on its link
  const Vector6d& stiffness() const { return K_; }     ///< K; zero in rows that are left out
  double energy() const { return energy_; }            ///< E [J]

  // At q, in SI units:
  Posed GraspPose(const VectorXd& q);      ///< X_WG
  Vector6d HandError(const VectorXd& q);   ///< e1 [6; m, rad], whole for a point grasp too
  Vector6d HandWrench(const VectorXd& q);  ///< K e1 [6; N, N m] on the grasp about Go, world axes
  VectorXd LoopError(const VectorXd& q);   ///< e2 [rows; m, rad]
  /// E W mu [rows; N, N m] from the multipliers of a Summary.
  VectorXd LoopMultipliers(const VectorXd& mu) const;
  /// The state of the tree at the last q that one of the above was called with.
  const TreeWorkspace<double>& workspace() const { return ws_; }
  /// At q: what ForwardKinematics and LoopErrors write.
  const TreeWorkspace<double>& WorkspaceAt(const VectorXd& q) {
    MoveTo(q);
    return ws_;
  }

 private:
  /// A velocity that moves the frame at the end of a chain, in the chain's order from its fixed
  /// end on.
  struct ChainVelocity {
    int node, v, axis;
    double sign;
  };
  using Chain = std::vector<ChainVelocity>;
  /// Weights on the second derivatives of a frame's displacement: f on positions, g on the first
  /// and G on the second derivative of the rotation.
  struct CurvatureWeights {
    Vector3d f, g;
    Matrix3d G;
  };

  void MoveTo(const VectorXd& q);
  void EvaluateGrasp(VectorXd* r, MatrixXd* J);
  void EvaluateLoops(VectorXd* c, MatrixXd* C);
  void AddGraspCurvature(MatrixXd* S);
  void AddLoopCurvature(int loop, const VectorXd& mu, MatrixXd* S);
  void AddChainCurvature(const Chain& chain, const CurvatureWeights& weights, MatrixXd* S) const;
  void UnitTwists(const Chain& chain, const Frame& X);
  Frame GraspInTree() const;
  Frame TargetInTree() const;

  const KinematicTree& tree_;
  GraspFrame grasp_;
  RotationError rotation_error_;
  Vector6d K_;
  double energy_ = 1;
  Vector6d root_;       // (K/E)^(1/2)
  VectorXd row_scale_;  // W; zero for loops that hold anyway
  Posed X_WH_;
  Chain grasp_chain_;                       // from the ground to G
  std::vector<Chain> loop_chains_;          // from F to M, per loop
  std::vector<Vector3d> angular_, linear_;  // of UnitTwists
  VectorXd q_;                              // where ws_ is
  TreeWorkspace<double> ws_;
};

}  // namespace vmech
