#include "vmech/hw_interface/arm/arm_model.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "vmech/base/screw_algebra.h"
#include "vmech/mechanisms/mass_properties.h"

namespace vmech {
namespace {

/// The body with a point mass at P fixed to it.
MassProperties WithPointMass(const MassProperties& body, double mass, const Vector3d& p_LoP) {
  const double sum = body.mass + mass;
  const Vector3d c = (body.mass * body.p_LoLcm + mass * p_LoP) / sum;
  const Matrix3d I = InertiaAboutPoint(body.I_Lcm, body.mass, body.p_LoLcm - c) +
                     InertiaAboutPoint(Matrix3d::Zero(), mass, p_LoP - c);
  return {sum, c, I};
}

std::shared_ptr<const ArmDescription> Checked(std::shared_ptr<const ArmDescription> arm) {
  const KinematicTree& tree = arm->tree;
  if (!tree.loops.empty() || tree.nq != tree.nv || tree.nv > kMaxArmJoints) {
    throw std::invalid_argument(fmt::format(
        "arm '{}': {} loops, {} coordinates, {} freedoms; a master arm is an open chain of at most "
        "{} revolute and prismatic joints",
        tree.mechanism.name, tree.loops.size(), tree.nq, tree.nv, kMaxArmJoints));
  }
  if (arm->torque_limit.size() != tree.nv || arm->posture.size() != tree.nv) {
    throw std::invalid_argument(fmt::format("arm '{}': torque_limit and posture need {} entries",
                                            tree.mechanism.name, tree.nv));
  }
  return arm;
}

}  // namespace

ArmDescription WithMassAtHandle(const ArmDescription& arm, double mass) {
  ArmDescription heavier = arm;
  if (mass == 0) return heavier;
  Mechanism mechanism = arm.tree.mechanism;
  for (size_t l = 0; l < mechanism.links.size(); ++l) {
    if (arm.tree.NodeOfLink(static_cast<int>(l)) != arm.handle_node) continue;
    const Posed X_LB = arm.tree.X_node_link(static_cast<int>(l)).inverse();
    MassProperties& body = mechanism.links[l].mass_properties;
    body = WithPointMass(body, mass, (X_LB * arm.X_BH).p);
    break;
  }
  heavier.tree = BuildKinematicTree(mechanism);
  return heavier;
}

ArmModel::ArmModel(std::shared_ptr<const ArmDescription> arm)
    : arm_(Checked(std::move(arm))),
      ws_(arm_->tree),
      inertias_(arm_->tree),
      columns_(joints()),
      J_(Matrix6Xd::Zero(6, joints())),
      M_(MatrixXd::Zero(joints(), joints())),
      bias_(VectorXd::Zero(joints())),
      rest_(VectorXd::Zero(joints())),
      acceleration_(VectorXd::Zero(joints())),
      factor_(MatrixXd::Identity(joints(), joints())) {  // one not computed yet cannot be copied
  ws_.reference.setZero();
  ws_.at(-1).X = {};
  SetGravity(arm_->tree.mechanism.gravity_W, &ws_);
  SetPosture(arm_->posture.data());
}

void ArmModel::SetPosture(const double* q) noexcept {
  ForwardKinematics(arm_->tree, q, &ws_);
}

Posed ArmModel::X_DH() const noexcept {
  return PoseOf(ws_.at(arm_->handle_node).X * arm_->X_BH);
}

const Matrix6Xd& ArmModel::J() noexcept {
  const Frame H = ws_.at(arm_->handle_node).X * arm_->X_BH;
  GraspJacobian(arm_->tree, ws_, arm_->handle_node, H, &columns_);
  for (int i = 0; i < joints(); ++i) J_.col(i) = Vector6Of(columns_[i]);
  return J_;
}

Screw ArmModel::WrenchAtBase(const Vector6d& F_Ho) const noexcept {
  const Double4 p_DH = PointInWorld(ws_.at(arm_->handle_node).X, arm_->X_BH.p);
  const Screw F = ScrewOf(F_Ho);
  return WrenchAt(p_DH, F.linear, F.angular);
}

/// h(q, v) - J'F.
void ArmModel::BiasForces(const VectorXd& v, const Wrenchd& F_Ho) noexcept {
  const KinematicTree& tree = arm_->tree;
  ForwardVelocities(tree, v.data(), &ws_);
  VelocityProducts(tree, &ws_);
  BodyInertias(tree, ws_, &inertias_);
  GyroscopicWrenches(tree, inertias_, &ws_);
  NewtonEuler<double>(tree, inertias_, nullptr, &ws_, bias_.data());
  const Screw F_Do = WrenchAtBase(F_Ho.Stacked());
  for (int i = 0; i < joints(); ++i) bias_[i] -= Power(F_Do, ws_.S[i]);
}

const VectorXd& ArmModel::GravityTorques() noexcept {
  BiasForces(rest_, Wrenchd{});
  return bias_;
}

JointArray ArmModel::TorqueRoom() noexcept {
  JointArray room = JointArray::Zero();
  const VectorXd& weight = GravityTorques();
  for (int i = 0; i < joints(); ++i) {
    room[i] = std::max(0.0, arm_->torque_limit[i] - std::abs(weight[i]));
  }
  return room;
}

/// A force f takes at most |f| |J_i| of joint i's torque, J_i the column's linear part.
WrenchLimit ArmModel::WrenchRoom(const JointArray& torque) noexcept {
  constexpr double kLeast = 1e-6;  // [N], [N m]: a limit is not zero
  constexpr double kNoLever = 1e-9;
  WrenchLimit room{.together = true};
  const Matrix6Xd& J = this->J();
  for (int i = 0; i < joints(); ++i) {
    const double by_force = std::max(J.col(i).head<3>().norm(), kNoLever);
    const double by_moment = std::max(J.col(i).tail<3>().norm(), kNoLever);
    room.force = std::min(room.force, std::max(torque[i] / by_force, kLeast));
    room.moment = std::min(room.moment, std::max(torque[i] / by_moment, kLeast));
  }
  return room;
}

const MatrixXd& ArmModel::MassMatrix() noexcept {
  BodyInertias(arm_->tree, ws_, &inertias_);
  CompositeMassMatrix(arm_->tree, ws_, &inertias_, &M_);
  return M_;
}

void ArmModel::Momenta(const double* v, double* momenta) noexcept {
  vmech::Momenta(arm_->tree, inertias_, v, &ws_, momenta);
}

double ArmModel::PotentialEnergy() noexcept {
  BodyInertias(arm_->tree, ws_, &inertias_);
  return WeightEnergy(arm_->tree.mechanism.gravity_W, inertias_);
}

const VectorXd& ArmModel::Accelerations(const VectorXd& v, const VectorXd& torque,
                                        const Wrenchd& F_Ho) noexcept {
  BiasForces(v, F_Ho);
  CompositeMassMatrix(arm_->tree, ws_, &inertias_, &M_);  // inertias are those of BiasForces
  factor_.compute(M_);
  // M v' = tau - h
  acceleration_ = torque - bias_;
  factor_.solveInPlace(acceleration_);
  return acceleration_;
}

}  // namespace vmech
