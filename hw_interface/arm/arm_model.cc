#include "vmech/hw_interface/arm/arm_model.h"

#include <fmt/format.h>

#include <stdexcept>

#include "vmech/base/screw_algebra.h"

namespace vmech {
namespace {

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
  return WeightEnergy(arm_->tree, inertias_);
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
