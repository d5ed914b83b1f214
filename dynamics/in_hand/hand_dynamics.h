#pragma once

#include <vector>

#include "vmech/base/linear_algebra/saddle_system.h"
#include "vmech/dynamics/in_hand/grasped_mechanism.h"
#include "vmech/dynamics/in_hand/passive_joints.h"

namespace vmech {

/// How w_d is found among the wrenches that move the mechanism as it moves.
enum class WrenchRule {
  kWorkless,  ///< w_d along the free motion alone: nothing that the constraints could carry
  kPaper,     ///< paper eq. (14) as printed: w_d and the cut wrenches in one minimum-norm step
};

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
///
/// A hand beside the path of the grasp frame is not the same as one on it. With S the second
/// derivatives of 1/2 e1'K e1 + mu' e2 at the nearest pose,
///
///   (J'K J + S) v + C' mu = J'K V_H,   C v = 0:   v = P V_H
///
/// is the velocity of the nearest pose. By the same equations the hand feels P' tau, as a wrench at
/// Ho, so that w_d V_H = tau' v: what the hand gives is what the mechanism gets. On the path, e1 =
/// 0, S vanishes.
class HandDynamics {
 public:
  /// Keeps references to the tree. `stiffness`: K, diagonal; rows that a point grasp ignores do not
  /// count. `q`: a closed pose, at which is judged whether the grasp moves every freedom.
  /// Freedoms that it does not move and that shift no centre of gravity, such as the spin of a rod
  /// between two spherical joints, move as they would from rest: with Z their motions, Z'M v = 0
  /// and Z'(M v' + h) = 0, so that no joint would have to carry what drives them.
  /// @throws std::invalid_argument if it leaves others loose, naming one; if no stiffness is above
  ///         zero; if a cut joint has springs or friction, or a joint has friction under load: they
  ///         are beyond this path.
  HandDynamics(const KinematicTree& tree, const GraspFrame& grasp, const Vector6d& stiffness,
               const VectorXd& q, WrenchRule rule = WrenchRule::kWorkless);

  /// Takes the closed pose q [nq]; returns that of the grasp frame.
  Posed SetPose(const VectorXd& q) noexcept;
  /// The same where a workspace of the tree is at q, with its loop errors.
  Posed SetPose(const VectorXd& q, const TreeWorkspace<double>& at_q) noexcept;
  /// There, with the twist and acceleration of Go, world axes [linear; angular], as far as the
  /// loops allow them, of a mechanism with a share of its inertia, in [0, 1]: weight, springs and
  /// dampers are whole. False, and results undefined, if a value is not finite.
  [[nodiscard]] bool Evaluate(const Vector6d& V_WG, const Vector6d& A_WG,
                              double inertia = 1) noexcept;

  // The same in two steps, for velocities and accelerations that are found otherwise.
  /// v() = P V_WH. `S` [nv, nv; J], null for a hand on the path; it is left out where it makes the
  /// pose no minimum. False if a value is not finite.
  /// `turn`: the rotation of e1 [rad]; a hand that turns by w changes it by w - turn x w / 2 .. .
  [[nodiscard]] bool FindVelocities(const Vector6d& V_WH, const MatrixXd* S,
                                    const Vector3d& turn = Vector3d::Zero()) noexcept;
  /// After FindVelocities: how heavy the mechanism is for a handle of masses D [kg, kg m^2], the
  /// largest a'P'M P a over a'D a. Directions with D = 0 do not count. One step of power iteration
  /// from where the last call ended: exact at once where there is one freedom.
  double InertiaRatio(const Vector6d& D) noexcept;
  /// After FindVelocities: the wrenches of a mechanism that is at v (for its dampers and friction)
  /// and has the velocity u and the rate of velocity udot as far as its inertia is concerned.
  [[nodiscard]] bool Evaluate(const VectorXd& v, const VectorXd& u, const VectorXd& udot) noexcept;

  // Of the last Evaluate.
  Vector6d Twist(const VectorXd& v) const noexcept;        ///< J v: of Go, world axes
  const VectorXd& v() const noexcept { return v_; }        ///< [nv]
  const VectorXd& vdot() const noexcept { return vdot_; }  ///< [nv], times the share of inertia
  const Vector6d& w_d() const noexcept { return w_d_; }    ///< hand on mechanism, world axes
  /// What the first link exerts on the second, about the second anchor's origin, in the axes of the
  /// first anchor; per joint of the mechanism.
  const std::vector<Wrenchd>& joints() const noexcept { return joints_; }
  /// Kinetic energy of the share of inertia, weight (zero with all centres of gravity at the height
  /// of KinematicTree::reference), springs [J].
  double Energy() const noexcept;

 private:
  bool Factor(const MatrixXd* S) noexcept;
  bool FactorWithoutCurvature() noexcept;
  void FindWrench() noexcept;
  void FindPaperWrench() noexcept;
  void SolveMotion(const Vector6d& b, const VectorXd& d, VectorXd* x) noexcept;
  void HoldIdleFreedoms();
  void Damp(const VectorXd& motion, double damping);
  void KeepThoseWithInertia(const MatrixXd& idle);
  void FollowIdleMotions() noexcept;
  void ReleaseIdleMotions() noexcept;

  const KinematicTree& tree_;
  WrenchRule rule_;
  Vector6d K_, root_K_;
  GraspedMechanism pose_;
  PassiveJoints passive_;
  SaddleSystem system_;
  SaddleSystem paper_system_;  // of eq. (14): no equations
  MatrixXd rootKJ_, A_, curved_A_;
  Vector3d turn_ = Vector3d::Zero();
  bool curved_ = false;                   // the factors are those of curved_A_
  Vector6d heaviest_ = Vector6d::Ones();  // direction of InertiaRatio
  VectorXd damping_;                      // [nv], of the trace of A
  /// A motion z of Z, z'M z = 1, and its momenta M z.
  struct IdleMotion {
    VectorXd z, Mz;
  };
  std::vector<IdleMotion> idle_;  // of the idle freedoms that have inertia
  VectorXd q_, v_, felt_v_, vdot_, tau_, x_, right_, d_, zero_, mu_;
  std::vector<Screw> cut_;  // what the cut joints exert by eq. (14)
  std::vector<Wrenchd> joints_;
  Vector6d w_d_ = Vector6d::Zero();
};

}  // namespace vmech
