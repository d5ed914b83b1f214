#include "vmech/dynamics/hand_dynamics.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "vmech/dynamics/newton_euler.h"
#include "vmech/dynamics/passive.h"
#include "vmech/dynamics/reactions.h"
#include "vmech/kinematics/forward_kinematics.h"
#include "vmech/kinematics/jacobian.h"
#include "vmech/kinematics/linear_algebra.h"
#include "vmech/kinematics/loops.h"

namespace vmech {
namespace {

/// W against K: large enough for three solves to leave 1e-9, small enough for the digits of K.
constexpr double kLoopWeight = 1e5;
constexpr int kSolves = 3;
/// Of the largest eigenvalue: holds what neither hand nor loops move, at a dead centre.
constexpr double kDamping = 1e-16;
constexpr double kSlowSliding = 1e-2;  // [m/s] or [rad/s]: dry friction builds up until here

Vector6d RowsThatCount(Vector6d K, GraspKind kind) {
  if (kind == GraspKind::kPoint) K.tail<3>().setZero();
  return K;
}

/// Stiffness of lengths [N/m]: of the positions, or of the rotations over L^2.
double MeanStiffness(const Vector6d& K, double length) {
  const double positions = K.head<3>().mean();
  return positions > 0 ? positions : K.tail<3>().mean() / (length * length);
}

bool HasPassive(const Joint& joint) {
  return std::any_of(joint.passive.begin(), joint.passive.end(), [](const Passive& p) {
    return p.stiffness != 0 || p.viscous != 0 || p.coulomb != 0;
  });
}

void RefuseFriction(const KinematicTree& tree) {
  for (const Joint& joint : tree.mechanism.joints) {
    if (joint.load_friction.coefficient == 0) continue;
    throw std::invalid_argument(fmt::format(
        "joint '{}': friction in proportion to the load is not rendered to a hand; give "
        "it `coulomb` or `viscous` friction",
        joint.name));
  }
  for (const Loop& loop : tree.loops) {
    const Joint& joint = tree.mechanism.joints[loop.joint];
    if (!HasPassive(joint)) continue;
    throw std::invalid_argument(
        fmt::format("joint '{}' is cut, but has a spring or friction; name another joint in `cuts`",
                    joint.name));
  }
}

}  // namespace

HandDynamics::HandDynamics(const KinematicTree& tree, const GraspFrame& grasp,
                           const Vector6d& stiffness, const VectorXd& q)
    : tree_(tree),
      grasp_(grasp),
      K_(RowsThatCount(stiffness, grasp.kind)),
      W_(VectorXd::Zero(tree.rows)),
      ws_(tree),
      J_(MatrixXd::Zero(6, tree.nv)),
      KJ_(J_),
      C_(MatrixXd::Zero(tree.rows, tree.nv)),
      WC_(C_),
      H_(MatrixXd::Zero(tree.nv, tree.nv)),
      factor_(tree.nv),
      q_(q),
      v_(VectorXd::Zero(tree.nv)),
      felt_v_(v_),
      vdot_(v_),
      tau_(v_),
      x_(v_),
      mu_(W_),
      d_(W_),
      Cx_(W_),
      none_(W_),
      applied_(tree.nodes.size()),
      joints_(tree.mechanism.joints.size()),
      spring_length_(tree.nv, 0.0) {
  RefuseFriction(tree);
  const double k = MeanStiffness(K_, tree.length);
  if (!(k > 0)) throw std::invalid_argument("hand: a stiffness above zero is needed");
  const VectorXd scale = LoopRowScale(tree);
  W_ = kLoopWeight * k * tree.length * tree.length * scale.cwiseAbs2();
  SetPose(q);
  RefuseIdleFreedoms();
}

/// Every velocity must show at the hand or in a loop.
void HandDynamics::RefuseIdleFreedoms() const {
  MatrixXd A(6 + tree_.rows, tree_.nv);
  const Vector6d root = K_.cwiseSqrt() / std::sqrt(MeanStiffness(K_, tree_.length));
  A << root.asDiagonal() * J_ / tree_.length, LoopRowScale(tree_).asDiagonal() * C_;
  constexpr double kMoved = 1e-6;
  const NullSpace free = FindNullSpace(A, kMoved);
  if (free.basis.cols() == 0) return;
  Eigen::Index most = 0;
  free.basis.col(0).cwiseAbs().maxCoeff(&most);
  throw std::invalid_argument(fmt::format(
      "the grasp does not move '{}': {} of the mechanism's freedoms stay loose in this hand. Hold "
      "another link, or hold it rigidly instead of at a point",
      NameOfVelocity(tree_, static_cast<int>(most)), free.basis.cols()));
}

bool HandDynamics::Evaluate(const Vector6d& V_WG, const Vector6d& A_WG, double inertia) noexcept {
  if (!Factor()) return false;
  SolveMotion(V_WG, none_, &v_);
  // s (M v' + c(q, v)) = M (s v') + c(q, s^1/2 v).
  felt_v_ = std::sqrt(inertia) * v_;
  ForwardVelocities(tree_, felt_v_.data(), &ws_);
  ForwardAccelerations<double>(tree_, felt_v_.data(), nullptr, &ws_);
  LoopAccelerationBias(tree_, &ws_);
  for (size_t l = 0; l < tree_.loops.size(); ++l) {
    const Loop& loop = tree_.loops[l];
    d_.segment(loop.row, loop.rows) = -ws_.loops[l].bias.head(loop.rows);
  }
  SolveMotion(inertia * A_WG - PointAcceleration(ws_, grasp_.node, X_WG_.p), d_, &vdot_);
  ForwardAccelerations<double>(tree_, felt_v_.data(), vdot_.data(), &ws_);
  RecursiveNewtonEuler<double>(tree_, tree_.mechanism.gravity_W, applied_.data(), &ws_);
  GeneralisedForces(tree_, ws_, tau_.data());
  PassiveForces();
  SolveWrenches();
  LoadJoints();
  return w_d_.allFinite();
}

const Posed& HandDynamics::SetPose(const VectorXd& q) noexcept {
  q_ = q;
  ForwardKinematics(tree_, q.data(), &ws_);
  LoopErrors(tree_, &ws_);
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

bool HandDynamics::Factor() noexcept {
  KJ_ = K_.asDiagonal() * J_;
  WC_ = W_.asDiagonal() * C_;
  H_.noalias() = J_.transpose() * KJ_;
  H_.noalias() += C_.transpose() * WC_;
  H_.diagonal().array() += kDamping * H_.trace();
  factor_.compute(H_);
  return factor_.info() == Eigen::Success;
}

/// min |J x - b|_K subject to C x = d.
void HandDynamics::SolveMotion(const Vector6d& b, const VectorXd& d, VectorXd* x) noexcept {
  mu_.setZero();
  for (int i = 0; i < kSolves; ++i) {
    x->noalias() = KJ_.transpose() * b;
    x->noalias() += WC_.transpose() * d;
    x->noalias() -= C_.transpose() * mu_;
    factor_.solveInPlace(*x);
    Cx_.noalias() = C_ * *x;
    mu_ += W_.cwiseProduct(Cx_ - d);
  }
}

/// tau_ = J' w_d + C' mu with w_d = K J x along the free motion.
void HandDynamics::SolveWrenches() noexcept {
  mu_.setZero();
  for (int i = 0; i < kSolves; ++i) {
    x_ = tau_;
    x_.noalias() -= C_.transpose() * mu_;
    factor_.solveInPlace(x_);
    Cx_.noalias() = C_ * x_;
    mu_ += W_.cwiseProduct(Cx_);
  }
  w_d_.noalias() = KJ_ * x_;
}

/// Takes from tau_ what springs, dampers and dry friction supply.
void HandDynamics::PassiveForces() noexcept {
  for (const TreeNode& node : tree_.nodes) {
    if (node.v < 0 || node.motion == NodeMotion::kSpherical) continue;
    const Passive& passive = tree_.mechanism.joints[node.joint].passive[node.freedom];
    const double rate = v_[node.v];
    const double dry = passive.coulomb * std::clamp(rate / kSlowSliding, -1.0, 1.0);
    spring_length_[node.v] = q_[node.q] - passive.rest;
    tau_[node.v] += passive.stiffness * spring_length_[node.v] + passive.viscous * rate + dry;
  }
}

/// F_Bo of the nodes relieved by the hand and the cut joints, then joint by joint.
void HandDynamics::LoadJoints() noexcept {
  const Wrenchd hand{w_d_.head<3>(), w_d_.tail<3>()};
  for (int n = grasp_.node; n >= 0; n = tree_.nodes[n].parent) {
    NodeState<double>& node = ws_.nodes[n];
    node.F_Bo -= hand.ShiftedBy(X_WG_.p - node.X_WB.p);
  }
  AddMultiplierWrenches(tree_, mu_.data(), &ws_);
  for (size_t j = 0; j < joints_.size(); ++j) {
    const JointPlacement& place = tree_.placements[j];
    if (place.tree_node < 0) continue;
    const Matrix3d R_WF = PoseInWorld(ws_, place.first_node, place.X_AF).R;
    const Vector3d p_WM = PoseInWorld(ws_, place.second_node, place.X_BM).p;
    const NodeState<double>& node = ws_.nodes[place.tree_node];
    const Wrenchd W = node.F_Bo.ShiftedBy(node.X_WB.p - p_WM);
    joints_[j] = (tree_.nodes[place.tree_node].reversed ? -W : W).In(R_WF);
  }
  for (size_t l = 0; l < tree_.loops.size(); ++l) {
    const Loop& loop = tree_.loops[l];
    joints_[loop.joint] = WrenchOfMultipliers(loop, ws_.loops[l], mu_.data() + loop.row);
  }
}

double HandDynamics::Energy() const noexcept {
  const Vector3d& gravity = tree_.mechanism.gravity_W;
  double energy = 0;
  for (size_t i = 0; i < tree_.nodes.size(); ++i) {
    const TreeNode& node = tree_.nodes[i];
    const NodeState<double>& s = ws_.nodes[i];
    if (node.v >= 0 && node.motion != NodeMotion::kSpherical) {
      const double length = spring_length_[node.v];
      const Passive& passive = tree_.mechanism.joints[node.joint].passive[node.freedom];
      energy += 0.5 * passive.stiffness * length * length;
    }
    if (node.link < 0) continue;
    const Vector3d c = s.X_WB.R * node.p_BoBcm;
    const Vector3d v_cm = s.v + s.w.cross(c);
    const Vector3d w_B = s.X_WB.R.transpose() * s.w;
    energy += 0.5 * (node.mass * v_cm.squaredNorm() + w_B.dot(node.I_Bcm * w_B));
    energy -= node.mass * gravity.dot(s.X_WB.p + c);
  }
  return energy;
}

}  // namespace vmech
