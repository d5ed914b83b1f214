#include "vmech/dynamics/held_pose.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "vmech/dynamics/reactions.h"
#include "vmech/kinematics/forward_kinematics.h"
#include "vmech/kinematics/loops.h"
#include "vmech/solvers/small_ldlt.h"

namespace vmech {

HeldPose::HeldPose(const KinematicTree& tree, const GraspFrame& grasp)
    : tree_(tree),
      grasp_(grasp),
      row_scale_(LoopRowScale(tree)),
      ws_(tree),
      J_(Matrix6Xd::Zero(6, tree.nv)),
      C_(MatrixXd::Zero(PaddedSize(tree.rows), tree.nv)),
      e2_(VectorXd::Zero(C_.rows())),
      mu_(VectorXd::Zero(tree.rows)) {}

const Posed& HeldPose::Set(const VectorXd& q) noexcept {
  SetLoops(q);
  return SetJacobians();
}

void HeldPose::SetLoops(const VectorXd& q) noexcept {
  ForwardKinematics(tree_, q.data(), &ws_);
  LoopErrors(tree_, &ws_);
  for (size_t l = 0; l < tree_.loops.size(); ++l) {
    const Loop& loop = tree_.loops[l];
    for (int i = loop.row, k = 0; k < loop.rows; ++i, ++k) {
      e2_[i] = row_scale_[i] * ws_.loops[l].e2[k];
    }
  }
}

const Posed& HeldPose::SetJacobians() noexcept {
  X_WG_ = PoseInWorld(ws_, grasp_.node, grasp_.X_BG);
  PointJacobian(tree_, ws_, grasp_.node, X_WG_.p, &J_);
  LoopJacobian(tree_, &ws_);
  const Vector6d* column = ws_.loop_columns.data();
  for (const Loop& loop : tree_.loops) {
    for (const LoopColumn& c : loop.columns) {
      for (int i = loop.row, k = 0; k < loop.rows; ++i, ++k) {
        C_(i, c.v) = row_scale_[i] * (*column)[k];
      }
      ++column;
    }
  }
  return X_WG_;
}

Vector6d HeldPose::Twist(const VectorXd& v) const noexcept {
  Vector6d V = Vector6d::Zero();
  for (int i = 0; i < tree_.nv; ++i) V += v[i] * J_.col(i);
  return V;
}

void HeldPose::AddForces(const Vector6d& w_Go, VectorXd* tau) const noexcept {
  for (int i = 0; i < tree_.nv; ++i) (*tau)[i] += J_.col(i).dot(w_Go);
}

void HeldPose::TakeLoopBias(VectorXd* d) noexcept {
  LoopAccelerationBias(tree_, &ws_);
  for (size_t l = 0; l < tree_.loops.size(); ++l) {
    const Loop& loop = tree_.loops[l];
    for (int i = loop.row, k = 0; k < loop.rows; ++i, ++k) {
      (*d)[i] = -row_scale_[i] * ws_.loops[l].bias[k];
    }
  }
}

void HeldPose::LoadJoints(const Vector6d& w_hand, const VectorXd& mu,
                          std::vector<Wrenchd>* joints) noexcept {
  const Wrenchd hand{w_hand.head<3>(), w_hand.tail<3>()};
  for (int n = grasp_.node; n >= 0; n = tree_.nodes[n].parent) {
    NodeState<double>& node = ws_.nodes[n];
    node.F_Bo -= hand.ShiftedBy(X_WG_.p - node.X_WB.p);
  }
  for (int i = 0; i < tree_.rows; ++i) mu_[i] = row_scale_[i] * mu[i];
  AddMultiplierWrenches(tree_, mu_.data(), &ws_);
  for (size_t j = 0; j < joints->size(); ++j) {
    const JointPlacement& place = tree_.placements[j];
    if (place.tree_node < 0) continue;
    const Matrix3d R_WF = PoseInWorld(ws_, place.first_node, place.X_AF).R;
    const Vector3d p_WM = PoseInWorld(ws_, place.second_node, place.X_BM).p;
    const NodeState<double>& node = ws_.nodes[place.tree_node];
    const Wrenchd W = node.F_Bo.ShiftedBy(node.X_WB.p - p_WM);
    (*joints)[j] = (tree_.nodes[place.tree_node].reversed ? -W : W).In(R_WF);
  }
  for (size_t l = 0; l < tree_.loops.size(); ++l) {
    const Loop& loop = tree_.loops[l];
    (*joints)[loop.joint] = WrenchOfMultipliers(loop, ws_.loops[l], mu_.data() + loop.row);
  }
}

double HeldPose::KineticEnergy() const noexcept {
  double energy = 0;
  for (size_t i = 0; i < tree_.nodes.size(); ++i) {
    const TreeNode& node = tree_.nodes[i];
    if (node.link < 0) continue;
    const NodeState<double>& s = ws_.nodes[i];
    const Vector3d v_cm = s.v + s.w.cross(s.X_WB.R * node.p_BoBcm);
    const Vector3d w_B = s.X_WB.R.transpose() * s.w;
    energy += 0.5 * (node.mass * v_cm.squaredNorm() + w_B.dot(node.I_Bcm * w_B));
  }
  return energy;
}

double HeldPose::WeightEnergy() const noexcept {
  double energy = 0;
  for (size_t i = 0; i < tree_.nodes.size(); ++i) {
    const TreeNode& node = tree_.nodes[i];
    if (node.link < 0) continue;
    energy -= node.mass * tree_.mechanism.gravity_W.dot(ws_.nodes[i].X_WB * node.p_BoBcm);
  }
  return energy;
}

void RefuseUnrenderedFriction(const KinematicTree& tree) {
  for (const Joint& joint : tree.mechanism.joints) {
    if (joint.load_friction.coefficient == 0) continue;
    throw std::invalid_argument(fmt::format(
        "joint '{}': friction in proportion to the load is not rendered to a hand; give "
        "it `coulomb` or `viscous` friction",
        joint.name));
  }
  for (const Loop& loop : tree.loops) {
    const Joint& joint = tree.mechanism.joints[loop.joint];
    if (std::none_of(joint.passive.begin(), joint.passive.end(), IsPassive)) continue;
    throw std::invalid_argument(
        fmt::format("joint '{}' is cut, but has a spring or friction; name another joint in `cuts`",
                    joint.name));
  }
}

bool IsPassive(const Passive& passive) {
  return passive.stiffness != 0 || passive.viscous != 0 || passive.coulomb != 0;
}

}  // namespace vmech
