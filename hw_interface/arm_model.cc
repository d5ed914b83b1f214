#include "vmech/hw_interface/arm_model.h"

#include <fmt/format.h>

#include <stdexcept>

#include "vmech/dynamics/newton_euler.h"
#include "vmech/kinematics/forward_kinematics.h"

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
      mass_memory_(arm_->tree),
      applied_(arm_->tree.nodes.size()),
      J_(Matrix6Xd::Zero(6, joints())),
      M_(MatrixXd::Zero(joints(), joints())),
      bias_(VectorXd::Zero(joints())),
      rest_(VectorXd::Zero(joints())),
      acceleration_(VectorXd::Zero(joints())),
      factor_(MatrixXd::Identity(joints(), joints())) {  // one not computed yet cannot be copied
  SetPosture(arm_->posture.data());
}

void ArmModel::SetPosture(const double* q) noexcept {
  ForwardKinematics(arm_->tree, q, &ws_);
  X_DH_ = PoseInWorld(ws_, arm_->handle_node, arm_->X_BH);
  PointJacobian(arm_->tree, ws_, arm_->handle_node, X_DH_.p, &J_);
}

void ArmModel::BiasForces(const VectorXd& v, const Wrenchd& F_Ho) noexcept {
  const Posed& X_DB = ws_.nodes[arm_->handle_node].X_WB;
  applied_[arm_->handle_node] = F_Ho.ShiftedBy(X_DH_.p - X_DB.p);
  ForwardVelocities(arm_->tree, v.data(), &ws_);
  ForwardAccelerations<double>(arm_->tree, v.data(), nullptr, &ws_);
  RecursiveNewtonEuler<double>(arm_->tree, arm_->tree.mechanism.gravity_W, applied_.data(), &ws_);
  GeneralisedForces(arm_->tree, ws_, bias_.data());
}

const VectorXd& ArmModel::GravityTorques() noexcept {
  BiasForces(rest_, Wrenchd{});
  return bias_;
}

const MatrixXd& ArmModel::MassMatrix() noexcept {
  CompositeMassMatrix(arm_->tree, ws_, &mass_memory_, &M_);
  return M_;
}

void ArmModel::Momenta(const double* v, double* momenta) noexcept {
  const KinematicTree& tree = arm_->tree;
  ForwardVelocities(tree, v, &ws_);
  for (size_t i = 0; i < tree.nodes.size(); ++i) {
    const TreeNode& node = tree.nodes[i];
    NodeState<double>& s = ws_.nodes[i];
    const Matrix3d& R = s.X_WB.R;
    const Vector3d c = R * node.p_BoBcm;
    const Vector3d linear = node.mass * (s.v + s.w.cross(c));
    const Vector3d w_B = R.transpose() * s.w, angular_B = node.I_Bcm * w_B;
    s.F_Bo = {linear, R * angular_B + c.cross(linear)};
  }
  for (size_t i = tree.nodes.size(); i-- > 0;) {
    const NodeState<double>& s = ws_.nodes[i];
    const int parent = tree.nodes[i].parent;
    if (parent < 0) continue;
    NodeState<double>& p = ws_.nodes[parent];
    p.F_Bo += s.F_Bo.ShiftedBy(s.X_WB.p - p.X_WB.p);
  }
  GeneralisedForces(tree, ws_, momenta);
}

double ArmModel::PotentialEnergy() const noexcept {
  const Vector3d& gravity = arm_->tree.mechanism.gravity_W;
  double energy = 0;
  for (size_t i = 0; i < ws_.nodes.size(); ++i) {
    const TreeNode& node = arm_->tree.nodes[i];
    energy -= node.mass * gravity.dot(ws_.nodes[i].X_WB * node.p_BoBcm);
  }
  return energy;
}

const VectorXd& ArmModel::Accelerations(const VectorXd& v, const VectorXd& torque,
                                        const Wrenchd& F_Ho) noexcept {
  BiasForces(v, F_Ho);
  factor_.compute(MassMatrix());
  // M v' = tau - h
  acceleration_ = torque - bias_;
  factor_.solveInPlace(acceleration_);
  return acceleration_;
}

}  // namespace vmech
