#include "vmech/dynamics/held_pose.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "vmech/dynamics/reactions.h"
#include "vmech/kinematics/forward_kinematics.h"
#include "vmech/kinematics/jacobian.h"
#include "vmech/kinematics/loops.h"

namespace vmech {

HeldPose::HeldPose(const KinematicTree& tree, const GraspFrame& grasp)
    : tree_(tree),
      grasp_(grasp),
      ws_(tree),
      J_(MatrixXd::Zero(6, tree.nv)),
      C_(MatrixXd::Zero(tree.rows, tree.nv)) {}

void HeldPose::SetLoops(const VectorXd& q) noexcept {
  ForwardKinematics(tree_, q.data(), &ws_);
  LoopErrors(tree_, &ws_);
}

const Posed& HeldPose::Set(const VectorXd& q) noexcept {
  SetLoops(q);
  LoopJacobian(tree_, &ws_);
  X_WG_ = PoseInWorld(ws_, grasp_.node, grasp_.X_BG);
  PointJacobian(tree_, ws_, grasp_.node, X_WG_.p, &J_);
  C_.setZero();
  for (size_t l = 0; l < tree_.loops.size(); ++l) {
    const Loop& loop = tree_.loops[l];
    const Vector6d* column = &ws_.loop_columns[ws_.first_column[l]];
    for (const LoopColumn& c : loop.columns) {
      C_.col(c.v).segment(loop.row, loop.rows) = column->head(loop.rows);
      ++column;
    }
  }
  return X_WG_;
}

void HeldPose::LoadJoints(const Vector6d& w_hand, const VectorXd& mu,
                          std::vector<Wrenchd>* joints) noexcept {
  const Wrenchd hand{w_hand.head<3>(), w_hand.tail<3>()};
  for (int n = grasp_.node; n >= 0; n = tree_.nodes[n].parent) {
    NodeState<double>& node = ws_.nodes[n];
    node.F_Bo -= hand.ShiftedBy(X_WG_.p - node.X_WB.p);
  }
  AddMultiplierWrenches(tree_, mu.data(), &ws_);
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
    (*joints)[loop.joint] = WrenchOfMultipliers(loop, ws_.loops[l], mu.data() + loop.row);
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
