#pragma once

#include <vector>

#include "vmech/base/linear_algebra/saddle_system.h"
#include "vmech/dynamics/in_hand/grasped_mechanism.h"
#include "vmech/dynamics/in_hand/passive_joints.h"

namespace vmech {

/// Dynamics of a mechanism that a hand moves, for the kHz path: what the hand must exert, and what
/// every joint carries, at one closed pose, from one factorisation and without a null space or a
/// rank decision. With the grasp's Jacobian J and the loops' C, a quantity x of the free motion
/// that fits b, min |J x - b|_K subject to C x = d, is that of a SaddleSystem
///
///   J'K J x + C' mu = c,   C x = d
///
///   velocities     c = J'K V_G,           d = 0
///   accelerations  c = J'K (A_G - J' v),  d = -C' v
///   wrenches       c = tau,               d = 0,  w_d = K J x          (paper eq. 9, 13)
///
/// tau = M q'' + h less springs and dampers of the joints in the tree. w_d is the smallest wrench,
/// in the metric K, that moves the mechanism so; mu, the wrenches of the cut joints, the smallest
/// that then keep the loops closed. Components that statics does not determine thus follow a rule
/// of their own, cheaper than those of a load study; certain components are the same.
class HandDynamics {
 public:
  /// Keeps references to the tree. `stiffness`: K, diagonal; rows that a point grasp ignores do not
  /// count. `q`: a closed pose, at which is judged whether the grasp moves every freedom.
  /// Freedoms that it does not move and that shift no centre of gravity, such as the spin of a rod
  /// between two spherical joints, stand still.
  /// @throws std::invalid_argument if it leaves others loose, naming one; or if a cut joint has
  ///         springs or friction, or a joint has friction under load: they are beyond this path.
  HandDynamics(const KinematicTree& tree, const GraspFrame& grasp, const Vector6d& stiffness,
               const VectorXd& q);

  /// Takes the closed pose q [nq]; returns that of the grasp frame.
  Posed SetPose(const VectorXd& q) noexcept;
  /// The same where a workspace of the tree is at q, with its loop errors.
  Posed SetPose(const VectorXd& q, const TreeWorkspace<double>& at_q) noexcept;
  /// There, with the twist and acceleration of Go, world axes [linear; angular], as far as the
  /// loops allow them, of a mechanism with a share of its inertia, in [0, 1]: weight, springs and
  /// dampers are whole. False, and results undefined, if a value is not finite.
  [[nodiscard]] bool Evaluate(const Vector6d& V_WG, const Vector6d& A_WG,
                              double inertia = 1) noexcept;

  // Of the last Evaluate.
  const VectorXd& v() const noexcept { return v_; }        ///< [nv]
  const VectorXd& vdot() const noexcept { return vdot_; }  ///< [nv], times the share of inertia
  const Vector6d& w_d() const noexcept { return w_d_; }    ///< hand on mechanism, at Go, world axes
  /// What the first link exerts on the second, about the second anchor's origin, in the axes of the
  /// first anchor; per joint of the mechanism.
  const std::vector<Wrenchd>& joints() const noexcept { return joints_; }
  /// Kinetic energy of the share of inertia, weight (zero with all centres of gravity at the height
  /// of Wo), springs [J].
  double Energy() const noexcept;

 private:
  bool Factor() noexcept;
  void SolveMotion(const Vector6d& b, const VectorXd& d, VectorXd* x) noexcept;
  void HoldIdleFreedoms();

  const KinematicTree& tree_;
  Vector6d K_, root_K_;
  GraspedMechanism pose_;
  PassiveJoints passive_;
  SaddleSystem system_;
  MatrixXd rootKJ_, A_;
  VectorXd damping_;  // [nv], of the trace of A
  VectorXd q_, v_, felt_v_, vdot_, tau_, x_, right_, d_, zero_, mu_;
  std::vector<Wrenchd> joints_;
  Vector6d w_d_ = Vector6d::Zero();
};

}  // namespace vmech
