#include "vmech/dynamics/simulation/equations/constrained_motion.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "vmech/base/screw_algebra.h"
#include "vmech/dynamics/rigid_body/newton_euler.h"
#include "vmech/kinematics/loops/cut_joint.h"
#include "vmech/kinematics/loops/dimensionless_loops.h"
#include "vmech/kinematics/loops/loops.h"
#include "vmech/kinematics/tree/forward_kinematics.h"
#include "vmech/mechanisms/freedoms.h"

namespace vmech {
namespace {

/// Rows begin at the first column, but where a tree without loops branches: with the last freedoms
/// first, a row then has those that hang on it, which come just before it.
std::vector<int> InertiaEnvelope(const KinematicTree& tree) {
  std::vector<int> first(tree.nv);
  for (int i = 0; i < tree.nv; ++i) first[i] = i;
  for (int n = static_cast<int>(tree.nodes.size()); n-- > 0;) {
    const int below = VelocitiesOf(tree.nodes[n].motion);
    for (int a = n; a >= 0 && below > 0; a = tree.nodes[a].parent) {
      const TreeNode& above = tree.nodes[a];
      for (int k = 0; k < VelocitiesOf(above.motion); ++k) {
        int& begin = first[tree.nv - 1 - (above.v + k)];
        begin = std::min(begin, tree.nv - (tree.nodes[n].v + below));
      }
    }
  }
  return first;
}

Eigen::Quaterniond QuaternionAt(const double* wxyz) {
  return {wxyz[0], wxyz[1], wxyz[2], wxyz[3]};
}

/// 1 rad/s, or a characteristic length a second.
double UnitOf(const KinematicTree& tree, const RateRow& row) {
  if (row.v >= 0) return VelocityScale(tree)[row.v];
  const Joint& joint = tree.mechanism.joints[tree.loops[row.loop].joint];
  return FreedomsOfType(joint.type).rotates[static_cast<size_t>(row.freedom)] ? 1 : tree.length;
}

}  // namespace

RateRow RateRowOf(const KinematicTree& tree, FreedomId at) {
  const int v = VelocityIndex(tree, at.joint, at.freedom);
  if (v >= 0) return {v, -1, 0};
  for (size_t l = 0; l < tree.loops.size(); ++l) {
    if (tree.loops[l].joint == at.joint) return {-1, static_cast<int>(l), at.freedom};
  }
  return {};
}

ConstrainedMotion::ConstrainedMotion(const LoadModel& model)
    : tree_(model.tree), ws_(model), free_(model.partition.driven) {
  const int nv = tree_.nv, f = freedoms();
  const bool open = tree_.loops.empty();
  if (open) {
    for (int v = 0; v < nv; ++v) free_[v] = v;
  }
  unit_ = VelocityScale(tree_);
  free_unit_ = unit_(free_);
  column_sizes_ = columns_here_ = VectorXd::Zero(nv);
  largest_columns_ = unit_.cwiseAbs2().cwiseInverse();
  least_inertia_ = model.no_inertia * free_unit_.cwiseAbs2().cwiseInverse();
  massless_.resize(f);
  inert_.reserve(f);
  if (open) M_ = MatrixXd::Zero(nv, nv);
  N_ = MatrixXd::Zero(nv, f);
  if (open) N_.setIdentity();
  MN_ = MatrixXd::Zero(nv, f);
  A_ = MatrixXd::Zero(f, f);
  inertia_factors_ = EnvelopeLdlt<double>(open ? InertiaEnvelope(tree_) : std::vector<int>(f));
  driving_ = right_ = s_ = reversed_ = VectorXd::Zero(f);
  step_ = momenta_ = VectorXd::Zero(nv);
  Hold({});
}

void ConstrainedMotion::Hold(std::vector<RateRow> rows) {
  rows_ = std::move(rows);
  const auto m = static_cast<Eigen::Index>(rows_.size());
  B_ = MatrixXd::Zero(m, freedoms());
  Y_ = MatrixXd::Zero(freedoms(), m);
  held_ = multipliers_ = weight_ = VectorXd::Zero(m);
  row_unit_.resize(m);
  for (Eigen::Index i = 0; i < m; ++i) row_unit_[i] = UnitOf(tree_, rows_[i]);
  held_factors_ = EnvelopeLdlt<double>(std::vector<int>(rows_.size()));
}

void ConstrainedMotion::SetPose(const double* q) noexcept {
  std::copy(q, q + tree_.nq, ws_.q.data());
  NormaliseQuaternions(tree_, ws_.q.data());
  ForwardKinematics(tree_, ws_.q.data(), &ws_.tree);
  FollowMechanism();
  LoopErrors(tree_, &ws_.tree);
  LoopJacobian(tree_, &ws_.tree);
  ws_.dependents.Factor(ws_.tree);
  BodyInertias(tree_, ws_.tree, &ws_.inertias);
  FindInertia();
  FactorInertia();
  FactorHeld();
}

void ConstrainedMotion::MeasureColumns() noexcept {
  columns_here_.setZero();
  const Vector6d* column = ws_.tree.loop_columns.data();
  for (const Loop& loop : tree_.loops) {
    for (const LoopColumn& c : loop.columns) {
      for (int i = 0; i < loop.rows; ++i) {
        const double size = (*column)[i] / (IsLengthRow(loop.type, i) ? tree_.length : 1);
        columns_here_[c.v] += size * size;
      }
      ++column;
    }
  }
  column_sizes_ = column_sizes_.cwiseMax(columns_here_.cwiseMin(largest_columns_));
}

/// Inertias about a point far away are known to the rounding of its distance squared.
void ConstrainedMotion::FollowMechanism() noexcept {
  constexpr double kFar = 10;  // characteristic lengths
  double mass = 0;
  Vector3d moment = Vector3d::Zero();
  for (size_t i = 0; i < tree_.nodes.size(); ++i) {
    mass += tree_.nodes[i].mass;
    moment += tree_.nodes[i].mass * Vector3Of(ws_.tree.nodes[i + 1].X.p);
  }
  if (!(moment.norm() > kFar * tree_.length * mass)) return;
  ws_.tree.reference += moment / mass;
  ws_.tree.at(-1).X.p = TripleOf<double>(-ws_.tree.reference);
  ForwardKinematics(tree_, ws_.q.data(), &ws_.tree);
}

double ConstrainedMotion::closure() const noexcept {
  return LargestLoopError(tree_, ws_.tree);
}

void ConstrainedMotion::FindInertia() noexcept {
  if (tree_.loops.empty()) {
    CompositeMassMatrix(tree_, ws_.tree, &ws_.inertias, &M_);
    MN_ = M_;
    A_ = M_;
    for (size_t i = 0; i < rows_.size(); ++i) B_(static_cast<int>(i), rows_[i].v) = 1;
    return;
  }
  for (int k = 0; k < freedoms(); ++k) FindMovingLinks(k);
  A_.noalias() = N_.transpose() * MN_;
  DropRowsThatStand();
}

/// A rate that stands still while the mechanism moves, as at the turn of a rocker, is held by
/// nothing: what rounding leaves of its row would stop the mechanism.
void ConstrainedMotion::DropRowsThatStand() noexcept {
  constexpr double kStands = 1e-11;
  for (int i = 0; i < B_.rows(); ++i) {
    const double moves = B_.row(i).cwiseAbs().dot(free_unit_);
    if (moves <= kStands * row_unit_[i]) B_.row(i).setZero();
  }
}

/// The k-th free motion, its momenta, and the held rates in it.
void ConstrainedMotion::FindMovingLinks(int k) noexcept {
  double* const N_k = N_.col(k).data();
  std::fill(N_k, N_k + tree_.nv, 0.0);
  N_k[free_[k]] = 1;
  ws_.dependents.CompleteVelocities(ws_.tree, N_k);
  Momenta(tree_, ws_.inertias, N_k, &ws_.tree, MN_.col(k).data());
  for (size_t i = 0; i < rows_.size(); ++i) {
    const RateRow& row = rows_[i];
    B_(static_cast<int>(i), k) =
        row.v >= 0 ? N_k[row.v] : CutJointRates(tree_, ws_.tree, row.loop)[row.freedom];
  }
}

/// Of A + B' w B, which has the same solutions, and inertia along what is held even where A has
/// none.
void ConstrainedMotion::FactorInertia() noexcept {
  const int f = freedoms();
  const double largest = f > 0 ? A_.diagonal().maxCoeff() : 0;
  const double least = f > 0 && least_inertia_.maxCoeff() > 0 ? least_inertia_.maxCoeff() : 1;
  for (int i = 0; i < B_.rows(); ++i) {
    const double size2 = B_.row(i).squaredNorm();
    weight_[i] = size2 > 0 ? std::max(largest, least) / size2 : 0;
  }
  for (int i = 0; i < f; ++i) massless_[i] = A_(i, i) <= least_inertia_[i];
  inertia_factors_.SetZero();
  for (int i = 0; i < f; ++i) {
    for (int j = 0; j <= i; ++j) {
      const bool none = massless_[i] || massless_[j];
      double entry = none ? (i == j) * least_inertia_[i] : A_(i, j);
      for (int r = 0; r < B_.rows(); ++r) entry += weight_[r] * B_(r, i) * B_(r, j);
      if (entry != 0) inertia_factors_.Add(f - 1 - i, f - 1 - j, entry);
    }
  }
  inertia_factors_.Factor();
  FindMotionsWithoutInertia();
}

/// A pivot is the inertia that a freedom has at least, however those of the pivots before it go
/// along.
void ConstrainedMotion::FindMotionsWithoutInertia() noexcept {
  const int f = freedoms();
  constexpr double kBeside = 2;  // what stands for no inertia
  inert_.clear();
  for (int i = 0; i < f; ++i) {
    const double inverse = inertia_factors_.inverse_pivot(i);
    if (inverse == 0 || 1 <= kBeside * least_inertia_[f - 1 - i] * inverse) inert_.push_back(i);
  }
}

VectorXd ConstrainedMotion::MotionWithoutInertia(int motion) const {
  VectorXd z(freedoms());
  inertia_factors_.MotionOfPivot(inert_[static_cast<size_t>(motion)], z.data());
  return N_ * z.reverse();
}

void ConstrainedMotion::FactorHeld() noexcept {
  const int m = static_cast<int>(rows_.size()), f = freedoms();
  if (m == 0) return;
  held_factors_.SetZero();
  for (int i = 0; i < m; ++i) {
    for (int k = 0; k < f; ++k) reversed_[f - 1 - k] = B_(i, k);
    inertia_factors_.Solve(reversed_.data());
    for (int k = 0; k < f; ++k) Y_(k, i) = reversed_[f - 1 - k];
    for (int j = 0; j <= i; ++j) held_factors_(i, j) = B_.row(j).dot(Y_.col(i));
  }
  held_factors_.Factor();
}

/// Takes from right_ what acts along motions without inertia, so that they stand still.
void ConstrainedMotion::LeaveOutUnresisted() noexcept {
  const int f = freedoms();
  double largest = 0;
  left_out_ = {};
  for (size_t i = 0; i < inert_.size(); ++i) {
    inertia_factors_.MotionOfPivot(inert_[i], reversed_.data());
    double force = 0;
    for (int k = 0; k < f; ++k) force += reversed_[f - 1 - k] * right_[k];
    const int freedom = f - 1 - inert_[i];
    right_[freedom] -= force;
    const double size = std::abs(force) * free_unit_[freedom];
    if (size <= largest) continue;
    largest = size;
    left_out_ = {std::abs(force), size, static_cast<int>(i)};
  }
}

/// A s = right - B' multipliers, B s = held. Uses `right_` up.
void ConstrainedMotion::SolveFree(VectorXd* s) noexcept {
  const int f = freedoms();
  if (!inert_.empty()) LeaveOutUnresisted();
  for (int i = 0; i < B_.rows(); ++i) {
    for (int k = 0; k < f; ++k) right_[k] += weight_[i] * held_[i] * B_(i, k);
  }
  for (int k = 0; k < f; ++k) reversed_[f - 1 - k] = right_[k];
  inertia_factors_.Solve(reversed_.data());
  for (int k = 0; k < f; ++k) (*s)[k] = reversed_[f - 1 - k];
  if (rows_.empty()) return;
  multipliers_.noalias() = B_ * *s - held_;
  held_factors_.Solve(multipliers_.data());
  // What is held at rest has no rate at all, and not what rounding would leave of it.
  constexpr double kRounding = 1e-15;
  for (int k = 0; k < f; ++k) {
    const double taken = Y_.row(k).dot(multipliers_), left = (*s)[k] - taken;
    (*s)[k] = std::abs(left) <= kRounding * std::abs(taken) ? 0 : left;
  }
}

void ConstrainedMotion::SetVelocities(const double* v, const double* rates) noexcept {
  const Eigen::Map<const VectorXd> given(v, tree_.nv);
  right_.noalias() = MN_.transpose() * given;
  for (Eigen::Index i = 0; i < held_.size(); ++i) held_[i] = rates ? rates[i] : 0;
  SolveFree(&s_);
  ws_.v.noalias() = N_ * s_;
  FindVelocityTerms();
}

void ConstrainedMotion::TakeVelocities(const double* v) noexcept {
  std::copy(v, v + tree_.nv, ws_.v.data());
  FindVelocityTerms();
}

void ConstrainedMotion::FindVelocityTerms() noexcept {
  ForwardVelocities(tree_, ws_.v.data(), &ws_.tree);
  VelocityProducts(tree_, &ws_.tree);
  LoopAccelerationBias(tree_, &ws_.tree);
  GyroscopicWrenches(tree_, ws_.inertias, &ws_.tree);
}

double ConstrainedMotion::SlopeOf(const RateRow& row) const noexcept {
  return row.v >= 0 ? ws_.vdot[row.v]
                    : CutJointAccelerations(tree_, ws_.tree, row.loop)[row.freedom];
}

double ConstrainedMotion::RateOf(const RateRow& row) const noexcept {
  return row.v >= 0 ? ws_.v[row.v] : CutJointRates(tree_, ws_.tree, row.loop)[row.freedom];
}

void ConstrainedMotion::Accelerate(const VectorXd& forces, const double* slopes) noexcept {
  for (const int v : free_) ws_.vdot[v] = 0;
  ws_.dependents.CompleteAccelerations(ws_.tree, ws_.vdot.data());
  ForwardAccelerations(tree_, ws_.vdot.data(), &ws_.tree);
  NewtonEuler(tree_, ws_.inertias, ws_.applied.data(), &ws_.tree, ws_.tau.data());
  step_ = forces - ws_.tau;
  driving_.noalias() = N_.transpose() * step_;
  right_ = driving_;
  for (size_t i = 0; i < rows_.size(); ++i) {
    held_[static_cast<int>(i)] = (slopes ? slopes[i] : 0) - SlopeOf(rows_[i]);
  }
  SolveFree(&s_);
  JudgeUnresisted(forces);
  multipliers_ *= -1;
  ws_.vdot.noalias() += N_ * s_;
  ForwardAccelerations(tree_, ws_.vdot.data(), &ws_.tree);
}

/// Of the forces there are, before they cancel: rounding is beside those.
void ConstrainedMotion::JudgeUnresisted(const VectorXd& forces) noexcept {
  unresisted_ = left_out_;
  if (unresisted_.motion < 0) return;
  double largest = 0;
  for (int v = 0; v < tree_.nv; ++v) {
    largest = std::max(largest, unit_[v] * (std::abs(forces[v]) + std::abs(ws_.tau[v])));
  }
  unresisted_.share = largest > 0 ? unresisted_.share / largest : 0;
}

double ConstrainedMotion::Close(double tolerance, double* q) noexcept {
  constexpr int kSteps = 8;
  SetPose(q);
  std::copy(ws_.q.data(), ws_.q.data() + tree_.nq, q);
  double error = closure();
  for (int step = 0; step < kSteps && !(error <= tolerance); ++step) {
    ws_.dependents.StepCoordinates(ws_.tree, q);
    SmallStep(tree_, ws_.q.data(), q, step_.data());
    right_.noalias() = MN_.transpose() * step_;
    for (size_t i = 0; i < rows_.size(); ++i) {
      held_[static_cast<int>(i)] = rows_[i].v >= 0 ? step_[rows_[i].v] : 0;
    }
    SolveFree(&s_);
    step_.noalias() = -(N_ * s_);
    MoveCoordinates(tree_, step_.data(), q);
    SetPose(q);
    error = closure();
  }
  return error;
}

void NormaliseQuaternions(const KinematicTree& tree, double* q) noexcept {
  if (tree.nq == tree.nv) return;
  for (const TreeNode& node : tree.nodes) {
    if (node.motion != NodeMotion::kSpherical) continue;
    Eigen::Map<Eigen::Vector4d>(q + node.q).normalize();
  }
}

void CoordinateRates(const KinematicTree& tree, const double* q, const double* v,
                     double* qdot) noexcept {
  for (const TreeNode& node : tree.nodes) {
    if (node.v < 0) continue;
    if (node.motion != NodeMotion::kSpherical) {
      qdot[node.q] = v[node.v];
      continue;
    }
    // q' = q w / 2, w in the axes of M
    const Eigen::Quaterniond rate =
        QuaternionAt(q + node.q) * Eigen::Quaterniond(0, v[node.v], v[node.v + 1], v[node.v + 2]);
    qdot[node.q] = 0.5 * rate.w();
    for (int k = 0; k < 3; ++k) qdot[node.q + 1 + k] = 0.5 * rate.vec()[k];
  }
}

void SmallStep(const KinematicTree& tree, const double* q0, const double* q1, double* d) noexcept {
  for (const TreeNode& node : tree.nodes) {
    if (node.v < 0) continue;
    if (node.motion != NodeMotion::kSpherical) {
      d[node.v] = q1[node.q] - q0[node.q];
      continue;
    }
    const Eigen::Quaterniond turn =
        QuaternionAt(q0 + node.q).conjugate() * QuaternionAt(q1 + node.q);
    const double sign = turn.w() < 0 ? -2 : 2;
    for (int k = 0; k < 3; ++k) d[node.v + k] = sign * turn.vec()[k];
  }
}

}  // namespace vmech
