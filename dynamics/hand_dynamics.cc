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

Vector6d RowsThatCount(Vector6d K, GraspKind kind) {
  if (kind == GraspKind::kPoint) K.tail<3>().setZero();
  return K;
}

/// Stiffness of lengths [N/m]: of the positions, or of the rotations over L^2.
double MeanStiffness(const Vector6d& K, double length) {
  const double positions = K.head<3>().mean();
  return positions > 0 ? positions : K.tail<3>().mean() / (length * length);
}

}  // namespace

HandDynamics::HandDynamics(const KinematicTree& tree, const GraspFrame& grasp,
                           const Vector6d& stiffness, const VectorXd& q)
    : tree_(tree),
      grasp_(grasp),
      K_(RowsThatCount(stiffness, grasp.kind)),
      W_(VectorXd::Zero(tree.rows)),
      pose_(tree, grasp),
      KJ_(pose_.J()),
      WC_(pose_.C()),
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
  RefuseUnrenderedFriction(tree);
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
  A << root.asDiagonal() * pose_.J() / tree_.length, LoopRowScale(tree_).asDiagonal() * pose_.C();
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
  TreeWorkspace<double>& ws = pose_.ws();
  SolveMotion(V_WG, none_, &v_);
  // s (M v' + c(q, v)) = M (s v') + c(q, s^1/2 v).
  felt_v_ = std::sqrt(inertia) * v_;
  ForwardVelocities(tree_, felt_v_.data(), &ws);
  ForwardAccelerations<double>(tree_, felt_v_.data(), nullptr, &ws);
  LoopAccelerationBias(tree_, &ws);
  for (size_t l = 0; l < tree_.loops.size(); ++l) {
    const Loop& loop = tree_.loops[l];
    d_.segment(loop.row, loop.rows) = -ws.loops[l].bias.head(loop.rows);
  }
  SolveMotion(inertia * A_WG - PointAcceleration(ws, grasp_.node, pose_.X_WG().p), d_, &vdot_);
  ForwardAccelerations<double>(tree_, felt_v_.data(), vdot_.data(), &ws);
  RecursiveNewtonEuler<double>(tree_, tree_.mechanism.gravity_W, applied_.data(), &ws);
  GeneralisedForces(tree_, ws, tau_.data());
  PassiveForces();
  SolveWrenches();
  pose_.LoadJoints(w_d_, mu_, &joints_);
  return w_d_.allFinite();
}

const Posed& HandDynamics::SetPose(const VectorXd& q) noexcept {
  q_ = q;
  return pose_.Set(q);
}

bool HandDynamics::Factor() noexcept {
  KJ_ = K_.asDiagonal() * pose_.J();
  WC_ = W_.asDiagonal() * pose_.C();
  H_.noalias() = pose_.J().transpose() * KJ_;
  H_.noalias() += pose_.C().transpose() * WC_;
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
    x->noalias() -= pose_.C().transpose() * mu_;
    factor_.solveInPlace(*x);
    Cx_.noalias() = pose_.C() * *x;
    mu_ += W_.cwiseProduct(Cx_ - d);
  }
}

/// tau_ = J' w_d + C' mu with w_d = K J x along the free motion.
void HandDynamics::SolveWrenches() noexcept {
  mu_.setZero();
  for (int i = 0; i < kSolves; ++i) {
    x_ = tau_;
    x_.noalias() -= pose_.C().transpose() * mu_;
    factor_.solveInPlace(x_);
    Cx_.noalias() = pose_.C() * x_;
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

double HandDynamics::Energy() const noexcept {
  double energy = pose_.KineticEnergy() + pose_.WeightEnergy();
  for (const TreeNode& node : tree_.nodes) {
    if (node.v < 0 || node.motion == NodeMotion::kSpherical) continue;
    const double length = spring_length_[node.v];
    const Passive& passive = tree_.mechanism.joints[node.joint].passive[node.freedom];
    energy += 0.5 * passive.stiffness * length * length;
  }
  return energy;
}

}  // namespace vmech
