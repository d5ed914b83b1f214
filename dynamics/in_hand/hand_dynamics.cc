#include "vmech/dynamics/in_hand/hand_dynamics.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "vmech/base/linear_algebra/linear_algebra.h"
#include "vmech/base/linear_algebra/small_ldlt.h"
#include "vmech/base/screw_algebra.h"
#include "vmech/dynamics/loads/pose/idle_freedoms.h"
#include "vmech/kinematics/tree/forward_kinematics.h"
#include "vmech/kinematics/tree/grasp_rows.h"
#include "vmech/kinematics/tree/validity.h"

namespace vmech {
namespace {

/// Of loops against K, see SaddleSystem.
constexpr double kLoopWeight = 1e5;
/// Of the trace: holds what neither hand nor loops move, at a dead centre.
constexpr double kDamping = 1e-11;
constexpr double kHeld = 1e-8;        // what neither moves anywhere and has no inertia
constexpr double kReleased = 1e-9;    // what has some: its motion is taken out again
constexpr double kTakesPart = 0.1;    // of the largest
constexpr double kNoInertia = 1e-10;  // of the largest
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

/// Stiffness of lengths [N/m]: of the positions, or of the rotations over L^2.
double MeanStiffness(const Vector6d& K, double length) {
  const double positions = K.head<3>().mean();
  return positions > 0 ? positions : K.tail<3>().mean() / (length * length);
}

}  // namespace

HandDynamics::HandDynamics(const KinematicTree& tree, const GraspFrame& grasp,
                           const Vector6d& stiffness, const VectorXd& q, WrenchRule rule)
    : tree_(tree),
      rule_(rule),
      K_(RowsThatCount(stiffness, grasp.kind)),
      root_K_(K_.cwiseSqrt()),
      pose_(tree, grasp),
      passive_(tree),
      system_(tree.nv, static_cast<int>(pose_.C().rows())),
      paper_system_(tree.nv, 0),
      rootKJ_(MatrixXd::Zero(PaddedSize(6), tree.nv)),
      A_(MatrixXd::Zero(tree.nv, tree.nv)),
      curved_A_(A_),
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
      cut_(tree.loops.size()),
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
  constexpr double kMoved = 1e-6;
  const NullSpace free = FindNullSpace(A, kMoved);
  TreeWorkspace<double> ws(tree_);
  ForwardKinematics(tree_, q_.data(), &ws);
  for (Eigen::Index k = 0; k < free.basis.cols(); ++k) {
    const VectorXd v = free.basis.col(k);
    Eigen::Index most = 0;
    v.cwiseAbs().maxCoeff(&most);
    if (ShiftOfCentres(tree_, v, &ws) > tree_.mechanism.tolerance) {
      throw std::invalid_argument(fmt::format(
          "the grasp does not move '{}': {} of the mechanism's freedoms stay loose in this hand. "
          "Hold another link, or hold it rigidly instead of at a point",
          NameOfVelocity(tree_, static_cast<int>(most)), free.basis.cols()));
    }
    Damp(v, kHeld);
  }
  KeepThoseWithInertia(free.basis);
}

/// What takes part in a motion.
void HandDynamics::Damp(const VectorXd& motion, double damping) {
  const double largest = motion.cwiseAbs().maxCoeff();
  for (int i = 0; i < tree_.nv; ++i) {
    if (std::abs(motion[i]) > kTakesPart * largest) damping_[i] = damping;
  }
}

/// The others have neither momentum nor force.
void HandDynamics::KeepThoseWithInertia(const MatrixXd& idle) {
  if (idle.cols() == 0) return;
  MatrixXd M = MatrixXd::Zero(tree_.nv, tree_.nv);
  pose_.ComputeMassMatrix(&M);
  const MatrixXd without =
      FindKernel(idle.transpose() * M * idle, kNoInertia * M.diagonal().maxCoeff());
  const MatrixXd with =
      without.cols() == 0 ? idle : idle * FindNullSpace(without.transpose(), 0.5).basis;
  for (Eigen::Index k = 0; k < with.cols(); ++k) {
    idle_.push_back({with.col(k), VectorXd::Zero(tree_.nv)});
    Damp(with.col(k), kReleased);
  }
}

/// From those of the last pose: (A + w C'C + D) z+ = D z, D the damping, leaves what is idle here
/// as it is, and of all else next to nothing.
void HandDynamics::FollowIdleMotions() noexcept {
  const MatrixXd& A = curved_ ? curved_A_ : A_;
  for (size_t k = 0; k < idle_.size(); ++k) {
    auto& [z, Mz] = idle_[k];
    right_ = damping_.cwiseProduct(z);
    system_.Solve(A, pose_.C(), right_, zero_, &z);
    for (size_t i = 0; i < k; ++i) z -= idle_[i].Mz.dot(z) * idle_[i].z;
    pose_.ComputeMomenta(z, &Mz);
    const double size = 1 / std::sqrt(z.dot(Mz));
    z *= size;
    Mz *= size;
  }
}

/// Z'tau = 0 by accelerations along Z.
void HandDynamics::ReleaseIdleMotions() noexcept {
  for (const auto& [z, Mz] : idle_) {
    const double along = z.dot(tau_);
    vdot_ -= along * z;
    tau_ -= along * Mz;
  }
  pose_.SetAccelerations(vdot_);
}

bool HandDynamics::Evaluate(const Vector6d& V_WG, const Vector6d& A_WG, double inertia) noexcept {
  if (!FindVelocities(V_WG, nullptr)) return false;
  // s (M v' + c(q, v)) = M (s v') + c(q, s^1/2 v).
  felt_v_ = std::sqrt(inertia) * v_;
  pose_.SetVelocities(felt_v_);
  pose_.ComputeLoopBias(-1, &d_);
  SolveMotion(inertia * A_WG - Vector6Of(pose_.GraspBias()), d_, &vdot_);
  return Evaluate(v_, felt_v_, vdot_);
}

bool HandDynamics::FindVelocities(const Vector6d& V_WH, const MatrixXd* S,
                                  const Vector3d& turn) noexcept {
  if (!Factor(S)) return false;
  turn_ = turn;
  Vector6d V = V_WH;
  V.tail<3>() -= 0.5 * turn.cross(V_WH.tail<3>());
  SolveMotion(V, zero_, &v_);
  if (!idle_.empty()) FollowIdleMotions();
  for (const auto& [z, Mz] : idle_) v_ -= Mz.dot(v_) * z;
  return std::isfinite(v_.sum());
}

double HandDynamics::InertiaRatio(const Vector6d& D) noexcept {
  SolveMotion(heaviest_, zero_, &x_);
  pose_.ComputeMomenta(x_, &tau_);
  FindWrench();
  Vector6d next;
  for (int i = 0; i < 6; ++i) next[i] = D[i] > 0 ? w_d_[i] / D[i] : 0;
  const double before = heaviest_.dot(D.cwiseProduct(heaviest_));
  const double after = next.dot(D.cwiseProduct(next));
  if (!(after > 0) || !(before > 0)) return 0;
  heaviest_ = next / std::sqrt(after);
  return std::sqrt(after / before);
}

bool HandDynamics::Evaluate(const VectorXd& v, const VectorXd& u, const VectorXd& udot) noexcept {
  pose_.SetVelocities(u);
  pose_.ComputeVelocityProducts();
  pose_.SetAccelerations(udot);
  pose_.ComputeForces(&tau_);
  passive_.AddForces(q_, v, &tau_);
  if (!idle_.empty()) {
    vdot_ = udot;
    ReleaseIdleMotions();
  }
  if (rule_ == WrenchRule::kPaper) {
    FindPaperWrench();
    return w_d_.allFinite();
  }
  FindWrench();
  // The joints carry what moves the mechanism at Go; the hand beside it feels another wrench.
  Vector6d felt = w_d_;
  felt.tail<3>() += 0.5 * turn_.cross(w_d_.tail<3>());
  if (curved_ && FactorWithoutCurvature()) FindWrench();
  system_.ComputeMultipliers(pose_.C(), zero_, &mu_);
  mu_ = -mu_;
  const Screw w = ScrewOf(w_d_);
  pose_.LoadJoints({&w, 1}, mu_, &joints_);
  w_d_ = felt;
  return w_d_.allFinite();
}

/// w_d = P' tau.
void HandDynamics::FindWrench() noexcept {
  system_.Solve(curved_ ? curved_A_ : A_, pose_.C(), tau_, zero_, &x_);
  w_d_ = K_.cwiseProduct(Vector6Of(pose_.Twist(x_)));
}

/// The least squares of eq. (14) by its normal equations: with B the six rows of every cut,
///
///   (J'J + B'B) x = tau,   w_d = J x,   w_cut = B x,     newtons and newton metres alike.
void HandDynamics::FindPaperWrench() noexcept {
  const Vector6d rows = root_K_.cwiseSign();  // those that a point grasp keeps
  pose_.ComputeWeightedJacobian(ScrewOf(rows), &rootKJ_);
  curved_A_.setZero();
  paper_system_.AddGram(rootKJ_, &curved_A_);
  for (size_t l = 0; l < cut_.size(); ++l) {
    pose_.ComputeCutRows(static_cast<int>(l), &rootKJ_);
    paper_system_.AddGram(rootKJ_, &curved_A_);
  }
  curved_A_.diagonal() += curved_A_.trace() * damping_;
  if (!paper_system_.Factor(curved_A_)) {
    w_d_.setConstant(kNan);
    return;
  }
  paper_system_.SolveOnce(pose_.C(), tau_, zero_, &x_);
  w_d_ = rows.cwiseProduct(Vector6Of(pose_.Twist(x_)));
  for (size_t l = 0; l < cut_.size(); ++l) cut_[l] = pose_.CutTwist(static_cast<int>(l), x_);
  const Screw w = ScrewOf(w_d_);
  pose_.LoadJoints({&w, 1}, cut_, &joints_);
}

Vector6d HandDynamics::Twist(const VectorXd& v) const noexcept {
  return Vector6Of(pose_.Twist(v));
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

bool HandDynamics::Factor(const MatrixXd* S) noexcept {
  pose_.ComputeWeightedJacobian(ScrewOf(root_K_), &rootKJ_);
  A_.setZero();
  system_.AddGram(rootKJ_, &A_);
  A_.diagonal() += A_.trace() * damping_;
  system_.SetConstraints(pose_.C());
  curved_ = S != nullptr;
  if (curved_) {
    curved_A_ = A_ + *S;
    curved_ = system_.Factor(curved_A_);
  }
  return curved_ || FactorWithoutCurvature();
}

bool HandDynamics::FactorWithoutCurvature() noexcept {
  curved_ = false;
  return system_.Factor(A_);
}

/// min |J x - b|_K subject to C x = d; beside the path, with S.
void HandDynamics::SolveMotion(const Vector6d& b, const VectorXd& d, VectorXd* x) noexcept {
  right_.setZero();
  pose_.AddForces(ScrewOf(K_.cwiseProduct(b)), &right_);
  system_.Solve(curved_ ? curved_A_ : A_, pose_.C(), right_, d, x);
}

double HandDynamics::Energy() const noexcept {
  return pose_.KineticEnergy() + pose_.WeightEnergy() + passive_.Energy(q_);
}

}  // namespace vmech
