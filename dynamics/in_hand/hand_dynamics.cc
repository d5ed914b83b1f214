#include "vmech/dynamics/in_hand/hand_dynamics.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "vmech/base/linear_algebra/linear_algebra.h"
#include "vmech/base/linear_algebra/small_ldlt.h"
#include "vmech/base/screw_algebra.h"
#include "vmech/dynamics/loads/pose/idle_freedoms.h"
#include "vmech/kinematics/tree/forward_kinematics.h"
#include "vmech/kinematics/tree/validity.h"

namespace vmech {
namespace {

/// Of loops against K, see SaddleSystem.
constexpr double kLoopWeight = 1e5;
/// Of the trace: holds what neither hand nor loops move, at a dead centre.
constexpr double kDamping = 1e-11;
constexpr double kHeld = 1e-8;  // what neither moves anywhere

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
      K_(RowsThatCount(stiffness, grasp.kind)),
      root_K_(K_.cwiseSqrt()),
      pose_(tree, grasp),
      passive_(tree),
      system_(tree.nv, static_cast<int>(pose_.C().rows())),
      rootKJ_(MatrixXd::Zero(PaddedSize(6), tree.nv)),
      A_(MatrixXd::Zero(tree.nv, tree.nv)),
      damping_(VectorXd::Constant(tree.nv, kDamping)),
      q_(q),
      v_(VectorXd::Zero(tree.nv)),
      felt_v_(v_),
      vdot_(v_),
      tau_(v_),
      x_(v_),
      right_(v_),
      d_(pose_.e2()),
      zero_(d_),
      mu_(d_),
      joints_(tree.mechanism.joints.size()) {
  RequireCoordinates("HandDynamics: q", tree, q);
  const double k = MeanStiffness(K_, tree.length);
  if (!(k > 0)) throw std::invalid_argument("hand: a stiffness above zero is needed");
  system_.SetWeight(kLoopWeight * k * tree.length * tree.length);
  SetPose(q);
  HoldIdleFreedoms();
}

/// Every velocity must show at the hand or in a loop, or be without consequence.
void HandDynamics::HoldIdleFreedoms() {
  MatrixXd A(6 + pose_.C().rows(), tree_.nv);
  const Vector6d root = root_K_ / std::sqrt(MeanStiffness(K_, tree_.length));
  A << root.asDiagonal() * pose_.J() / tree_.length, pose_.C();
  constexpr double kMoved = 1e-6, kTakesPart = 0.1;
  const NullSpace free = FindNullSpace(A, kMoved);
  TreeWorkspace<double> ws(tree_);
  ForwardKinematics(tree_, q_.data(), &ws);
  for (Eigen::Index k = 0; k < free.basis.cols(); ++k) {
    const VectorXd v = free.basis.col(k);
    Eigen::Index most = 0;
    const double largest = v.cwiseAbs().maxCoeff(&most);
    if (ShiftOfCentres(tree_, v, &ws) > tree_.mechanism.tolerance) {
      throw std::invalid_argument(fmt::format(
          "the grasp does not move '{}': {} of the mechanism's freedoms stay loose in this hand. "
          "Hold another link, or hold it rigidly instead of at a point",
          NameOfVelocity(tree_, static_cast<int>(most)), free.basis.cols()));
    }
    for (int i = 0; i < tree_.nv; ++i) {
      if (std::abs(v[i]) > kTakesPart * largest) damping_[i] = kHeld;
    }
  }
}

bool HandDynamics::Evaluate(const Vector6d& V_WG, const Vector6d& A_WG, double inertia) noexcept {
  if (!Factor()) return false;
  SolveMotion(V_WG, zero_, &v_);
  // s (M v' + c(q, v)) = M (s v') + c(q, s^1/2 v).
  felt_v_ = std::sqrt(inertia) * v_;
  pose_.SetVelocities(felt_v_);
  pose_.ComputeLoopBias(-1, &d_);
  SolveMotion(inertia * A_WG - Vector6Of(pose_.GraspBias()), d_, &vdot_);
  pose_.SetAccelerations(vdot_);
  pose_.ComputeForces(&tau_);
  passive_.AddForces(q_, v_, &tau_);
  system_.Solve(A_, pose_.C(), tau_, zero_, &x_);
  w_d_ = K_.cwiseProduct(Vector6Of(pose_.Twist(x_)));
  system_.ComputeMultipliers(pose_.C(), zero_, &mu_);
  mu_ = -mu_;
  pose_.LoadJoints(ScrewOf(w_d_), mu_, &joints_);
  return w_d_.allFinite();
}

Posed HandDynamics::SetPose(const VectorXd& q) noexcept {
  q_ = q;
  pose_.Set(q);
  return pose_.X_WG();
}

Posed HandDynamics::SetPose(const VectorXd& q, const TreeWorkspace<double>& at_q) noexcept {
  q_ = q;
  pose_.Set(at_q);
  return pose_.X_WG();
}

bool HandDynamics::Factor() noexcept {
  pose_.ComputeWeightedJacobian(ScrewOf(root_K_), &rootKJ_);
  A_.setZero();
  system_.AddGram(rootKJ_, &A_);
  A_.diagonal() += A_.trace() * damping_;
  system_.SetConstraints(pose_.C());
  return system_.Factor(A_);
}

/// min |J x - b|_K subject to C x = d.
void HandDynamics::SolveMotion(const Vector6d& b, const VectorXd& d, VectorXd* x) noexcept {
  right_.setZero();
  pose_.AddForces(ScrewOf(K_.cwiseProduct(b)), &right_);
  system_.Solve(A_, pose_.C(), right_, d, x);
}

double HandDynamics::Energy() const noexcept {
  return pose_.KineticEnergy() + pose_.WeightEnergy() + passive_.Energy(q_);
}

}  // namespace vmech
