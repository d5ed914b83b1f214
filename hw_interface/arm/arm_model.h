#pragma once

#include <Eigen/Cholesky>
#include <memory>
#include <vector>

#include "vmech/dynamics/in_hand/wrench_limit.h"
#include "vmech/dynamics/rigid_body/newton_euler.h"
#include "vmech/kinematics/tree/forward_kinematics.h"
#include "vmech/kinematics/tree/kinematic_tree.h"

namespace vmech {

/// The most joints that an arm may have.
inline constexpr int kMaxArmJoints = 16;
/// A number for each of an arm's joints, and zeros for those that it does not have.
using JointArray = Eigen::Array<double, kMaxArmJoints, 1>;

/// A master that is an arm: an open chain of revolute and prismatic joints with its mass
/// properties, limits and passive forces. World of the tree is the master's base D.
struct ArmDescription {
  KinematicTree tree;     ///< its root is D; one node to a joint
  int handle_node = -1;   ///< index in the tree's nodes
  Posed X_BH;             ///< the handle in its node
  VectorXd torque_limit;  ///< of each motor [N m] or [N]
  VectorXd posture;       ///< the nominal posture [rad] or [m]
};

/// The arm with a point mass [kg] fixed to its handle, at Ho: the part of an operator's hand that
/// moves along.
ArmDescription WithMassAtHandle(const ArmDescription& arm, double mass);

/// Kinematics and rigid-body dynamics of an arm with memory for one posture:
///
///   V_DH = J v,   M(q) v' + h(q, v) = tau + J' F_Ho,
///
/// F_Ho what acts on the handle from outside. No function but the constructor allocates.
class ArmModel {
 public:
  /// @throws std::invalid_argument if the arm is not an open chain of at most kMaxArmJoints joints,
  ///         or if its torque limits or posture are not a number per joint.
  explicit ArmModel(std::shared_ptr<const ArmDescription> arm);

  const ArmDescription& description() const noexcept { return *arm_; }  ///< as it was given
  /// The same, shared, for those who keep it.
  std::shared_ptr<const ArmDescription> shared_description() const noexcept { return arm_; }
  int joints() const noexcept { return arm_->tree.nv; }  ///< at most kMaxArmJoints

  /// Everything below is at the posture set last; `q` has joints() entries.
  void SetPosture(const double* q) noexcept;

  Posed X_DH() const noexcept;    ///< the handle in the device's base
  const Matrix6Xd& J() noexcept;  ///< [6, joints], about Ho, axes of D
  /// Columns of J about Do [joints].
  const std::vector<Screw>& S() const noexcept { return ws_.S; }
  /// A wrench on the handle, about Ho, as one about Do: its power on a column of S is a torque.
  Screw WrenchAtBase(const Vector6d& F_Ho) const noexcept;

  /// The torques that hold the arm still against gravity, h(q, 0).
  const VectorXd& GravityTorques() noexcept;
  /// What holding the arm against gravity leaves of each motor's torque, not below zero.
  JointArray TorqueRoom() noexcept;
  /// The force and the moment at the handle, in any direction, that so much torque can exert.
  WrenchLimit WrenchRoom(const JointArray& torque) noexcept;
  /// M(q).
  const MatrixXd& MassMatrix() noexcept;
  /// M(q) v, the joints' momenta, in one pass out and one back; `v` and `momenta` have joints()
  /// entries.
  void Momenta(const double* v, double* momenta) noexcept;
  /// - sum m g . p_cm [J], zero where every centre of gravity is at the height of Do.
  double PotentialEnergy() noexcept;
  /// v' from the velocities, the joints' torques (motors and passive ones together) and the wrench
  /// on the handle. `v`, `torque` have joints() entries; so has the result.
  const VectorXd& Accelerations(const VectorXd& v, const VectorXd& torque,
                                const Wrenchd& F_Ho) noexcept;

 private:
  void BiasForces(const VectorXd& v, const Wrenchd& F_Ho) noexcept;

  std::shared_ptr<const ArmDescription> arm_;
  TreeWorkspace<double> ws_;  // about Do
  TreeInertias<double> inertias_;
  std::vector<Screw> columns_;  // of J
  Matrix6Xd J_;
  MatrixXd M_;
  VectorXd bias_, rest_, acceleration_;
  Eigen::LLT<MatrixXd> factor_;
};

}  // namespace vmech
