#include "vmech/kinematics/inverse/hand_tracker.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "vmech/base/check_range.h"
#include "vmech/base/linear_algebra/signed_elimination.h"
#include "vmech/base/linear_algebra/small_ldlt.h"
#include "vmech/kinematics/inverse/configuration_distance.h"
#include "vmech/kinematics/loops/unseen_motions.h"
#include "vmech/kinematics/tree/validity.h"

namespace vmech {
namespace {

/// |det(A'A_ref)| over det(A_ref'A_ref), below which a pose is in the dead zone: nearly at a dead
/// centre, on one side or the other.
constexpr double kDeadZone = 1e-3;
/// How far a pose in the dead zone is moved back to its side [rad or m].
constexpr double kBeside = 2e-3;
/// The reference moves on when it is so far behind [rad or m]; near a dead centre it stays back as
/// long as it tells something.
constexpr double kReferenceBehind = 0.05, kReferenceRange = 0.2;
/// det(A'A_ref) over the largest det(A'A) so far, below which a pose is near a dead centre: where
/// the hand moves the mechanism 30 times less than elsewhere.
constexpr double kReferenceNear = 1e-3;
/// Added to A'A_ref, as a part of its largest diagonal: exactly singular poses have logarithms too.
constexpr double kFloor = 1e-12;
/// A step that is longer than this part of the one before calls for second derivatives.
constexpr double kSlow = 0.02;
/// After a step as long as this at most [rad or m], the next may take the same derivatives.
constexpr double kShort = 1e-2;
/// ..if it is shorter by this.
constexpr double kContraction = 0.25;
constexpr int kInverseIterations = 4;
constexpr int kClosingSteps = 3;
constexpr double kClosingWeight = 1e3;

/// The motions that neither hand nor loops see at q, orthonormal velocities [nv, count].
MatrixXd UnseenVelocities(InverseKinematics* problem, const VectorXd& q) {
  const UnseenMotions unseen = FindUnseenMotions(problem, q);
  MatrixXd velocities = TangentScale(problem->tree()).asDiagonal() * unseen.basis;
  Orthonormalise(velocities);
  return velocities;
}

}  // namespace

std::string_view NameOf(TrackStatus status) {
  switch (status) {
    case TrackStatus::kNotRun:
      return "not run";
    case TrackStatus::kFollowed:
      return "followed";
    case TrackStatus::kCatchingUp:
      return "catching up";
    case TrackStatus::kDeadCentre:
      return "held at a dead centre";
    case TrackStatus::kJump:
      return "held, jump refused";
    case TrackStatus::kLost:
      return "held, loops open";
  }
  return "?";
}

void TrackOptions::Validate() const {
  kinematics.Validate();
  CheckRange("TrackOptions", "weight", weight, 1, 1e4);
  CheckRange("TrackOptions", "steps", steps, 1, 20);
  CheckRange("TrackOptions", "rescue_iterations", rescue_iterations, 0, 100);
  CheckRange("TrackOptions", "max_move", max_move, 1e-6, 1);
  CheckRange("TrackOptions", "closure_tolerance", closure_tolerance, 1e-14, 1e-3);
  CheckRange("TrackOptions", "step_tolerance", step_tolerance, 1e-14, 1e-3);
}

std::string TrackSummary::BriefReport() const {
  return fmt::format(
      "{} targets: {} followed, {} being caught up with, {} held ({} at dead centres, {} jumps "
      "refused, {} with open loops); {} needed the line search; loops closed to {:.2g}",
      targets, followed, catching_up, held(), dead_centre, jumps, lost, rescued, worst_closure);
}

HandTracker::Closing::Closing(InverseKinematics& problem)
    : ConstrainedLeastSquares({problem.sizes().coordinates, problem.sizes().tangents,
                               problem.sizes().tangents, problem.sizes().constraints},
                              problem.bounds()),
      problem_(problem) {}

void HandTracker::Closing::Evaluate(const VectorXd& q, VectorXd* r, MatrixXd* J, VectorXd* c,
                                    MatrixXd* C) {
  if (r) r->setZero();
  if (J) J->setIdentity();
  problem_.Evaluate(q, nullptr, nullptr, c, C);
}

void HandTracker::Closing::Plus(const VectorXd& q, const VectorXd& dq, VectorXd* q_plus) const {
  problem_.Plus(q, dq, q_plus);
}

HandTracker::HandTracker(const KinematicTree& tree, const GraspFrame& grasp, const VectorXd& q,
                         const TrackOptions& options)
    : problem_(tree, grasp, options.kinematics),
      closing_(problem_),
      workspace_(problem_),
      closing_workspace_(closing_),
      options_(options),
      q_(q),
      trial_(q),
      good_multipliers_(VectorXd::Zero(tree.rows)),
      at_trial_(problem_.sizes()),
      A_(MatrixXd::Zero(PaddedSize(problem_.sizes().residuals + tree.rows), tree.nv)),
      product_(tree.nv, tree.nv),
      normal_(tree.nv),
      step_(tree.nv),
      dq_(tree.nv),
      origin_(q) {
  options.Validate();
  RequireCoordinates("HandTracker: q", tree, q);
  rescue_options_.weight = options.weight;
  rescue_options_.max_weight = std::max(options.weight, rescue_options_.max_weight);
  rescue_options_.max_step = options.max_move / std::max(1, options.rescue_iterations);
  rescue_options_.stopping.max_iterations = std::max(1, options.rescue_iterations);
  closing_options_.weight = closing_options_.max_weight = kClosingWeight;
  problem_.SetTarget(problem_.GraspPose(q));
  at_trial_.Evaluate(problem_, q);
  RequireClosed("HandTracker", at_trial_.c.lpNorm<Eigen::Infinity>(), options.closure_tolerance);
  StackJacobians();
  unseen_ = unseen_reference_ = UnseenVelocities(&problem_, q);
  unseen_weight_ = A_.colwise().squaredNorm().maxCoeff();
  SetReference();
}

TrackStatus HandTracker::Advance(const Posed& X_WH) noexcept {
  ++summary_.targets;
  problem_.SetTarget(X_WH);
  trial_ = q_;
  Progress progress = TakeSteps();
  TrackStatus verdict = Judge();
  if ((verdict != TrackStatus::kFollowed || progress == Progress::kNone) &&
      options_.rescue_iterations > 0) {
    progress = Rescue();
    verdict = Judge();
  }
  if (verdict == TrackStatus::kJump) {
    switch (FindMirrorImage()) {
      case Beyond::kTurningBack:
        progress = TakeSteps();
        verdict = Judge();
        break;
      case Beyond::kPassable:
        verdict = TrackStatus::kFollowed;
        break;
      case Beyond::kUnknown:
        break;
    }
  }
  if (verdict == TrackStatus::kFollowed) return Accept(progress);
  if (verdict == TrackStatus::kDeadCentre && OffsetFromSingularity()) MoveToTrial();
  return Hold(verdict);
}

/// Gauss-Newton, and with second derivatives once it turns out to be slow.
HandTracker::Progress HandTracker::TakeSteps() noexcept {
  double first_error = 0, last_step = 0;
  bool slow = false;
  for (int i = 0; i < options_.steps; ++i) {
    const bool chord = i > 0 && !slow && TakeChordStep(last_step);
    if (!chord && !TakeStep(slow) && !(slow && TakeStep(false))) return Progress::kNone;
    const double size = workspace_.step.dx.lpNorm<Eigen::Infinity>();
    const bool arrived = size <= options_.step_tolerance;
    if (arrived || i + 1 == options_.steps) TakeClosureStep(size);
    if (arrived) return Progress::kArrived;
    slow = slow || (i > 0 && size > kSlow * last_step);
    if (i == 0) first_error = workspace_.step.at_x.r.squaredNorm();
    last_step = size;
  }
  return workspace_.step.at_x.r.squaredNorm() < first_error ? Progress::kSome : Progress::kNone;
}

// Paper eq. (8) with the multiplier update, as Step() in augmented_lagrangian.h.
bool HandTracker::TakeStep(bool with_curvature) noexcept {
  constexpr double kDamping = 1e-12;
  WeightedStep& step = workspace_.step;
  step.ForgetScale();
  step.use_curvature = with_curvature;
  const double lambda = options_.weight;
  if (!Linearize()) return false;
  if (!step.Compute(problem_, trial_, kDamping, options_.max_move / options_.steps)) return false;
  workspace_.multipliers += lambda * lambda * step.PredictConstraints();
  problem_.Plus(trial_, step.dx, &trial_);
  return true;
}

/// The same with the derivatives and factors of the step before, where that was short and this one
/// is shorter. The pull of the hand, and that of the loops that resist it, has turned with the
/// mechanism meanwhile, which old derivatives do not see: it has to be too weak to count.
bool HandTracker::TakeChordStep(double last_step) noexcept {
  const double most_pull = options_.step_tolerance / last_step;
  if (last_step > kShort) return false;
  if (workspace_.multipliers.lpNorm<Eigen::Infinity>() > most_pull) return false;
  if (workspace_.step.LargestResidualAhead() > most_pull) return false;
  WeightedStep& step = workspace_.step;
  const double lambda = options_.weight;
  const double max_step = options_.max_move / options_.steps;
  if (!step.ComputeChord(problem_, trial_, lambda, workspace_.multipliers, max_step)) return false;
  if (step.dx.lpNorm<Eigen::Infinity>() > kContraction * last_step) return false;
  workspace_.multipliers += lambda * lambda * step.PredictConstraints();
  problem_.Plus(trial_, step.dx, &trial_);
  return true;
}

/// The loops are as the last target left them: the hand alone has moved.
bool HandTracker::Linearize() noexcept {
  WeightedStep& step = workspace_.step;
  const VectorXd& mu = workspace_.multipliers;
  if (!at_q_) return step.Linearize(problem_, trial_, options_.weight, mu);
  at_q_ = false;
  step.at_x.c.swap(at_trial_.c);
  step.at_x.C.swap(at_trial_.C);
  problem_.Evaluate(trial_, &step.at_x.r, &step.at_x.J, nullptr, nullptr);
  return step.FormEquations(problem_, trial_, options_.weight, mu);
}

/// Takes back what the last step has opened, with the factors at hand.
void HandTracker::TakeClosureStep(double last_step) noexcept {
  WeightedStep& step = workspace_.step;
  problem_.Evaluate(trial_, nullptr, nullptr, &at_trial_.c, nullptr);
  if (IsClosed()) return;
  if (step.ComputeClosure(problem_, trial_, options_.weight, at_trial_.c, last_step)) {
    problem_.Plus(trial_, step.dx, &trial_);
  }
}

/// From the last good pose with second derivatives and descent.
HandTracker::Progress HandTracker::Rescue() noexcept {
  ++summary_.rescued;
  trial_ = q_;
  workspace_.multipliers = good_multipliers_;
  const FastOutcome outcome = Solve(problem_, rescue_options_, &trial_, &workspace_);
  return outcome.claim == SolveStatus::kConverged ? Progress::kArrived : Progress::kSome;
}

/// The shortest way to closed loops; leaves at_trial_ there.
void HandTracker::Close() noexcept {
  problem_.Evaluate(trial_, nullptr, nullptr, &at_trial_.c, nullptr);
  for (int i = 0; i < kClosingSteps && !IsClosed(); ++i) {
    closing_workspace_.multipliers.setZero();
    if (!Step(closing_, closing_options_, &trial_, &closing_workspace_).ok) break;
    problem_.Evaluate(trial_, nullptr, nullptr, &at_trial_.c, nullptr);
  }
  problem_.Evaluate(trial_, &at_trial_.r, &at_trial_.J, nullptr, &at_trial_.C);
}

/// Whether trial_ may follow the last good pose: kFollowed, or why not.
TrackStatus HandTracker::Judge() noexcept {
  Close();
  StackJacobians();
  if (!std::isfinite(A_.sum() + at_trial_.r.sum() + at_trial_.c.sum())) return TrackStatus::kLost;
  determinant_ = BranchDeterminant();
  if (std::abs(determinant_) < kDeadZone) return TrackStatus::kDeadCentre;
  if (determinant_ < 0) return TrackStatus::kJump;
  return IsClosed() ? TrackStatus::kFollowed : TrackStatus::kLost;
}

bool HandTracker::IsClosed() const noexcept {
  return at_trial_.c.lpNorm<Eigen::Infinity>() <= options_.closure_tolerance;
}

void HandTracker::StackJacobians() noexcept {
  const Eigen::Index residuals = at_trial_.J.rows(), constraints = at_trial_.C.rows();
  for (Eigen::Index j = 0; j < A_.cols(); ++j) {
    double* A_j = A_.data() + j * A_.rows();
    std::copy_n(at_trial_.J.data() + j * residuals, residuals, A_j);
    std::copy_n(at_trial_.C.data() + j * constraints, constraints, A_j + residuals);
  }
}

/// det(A'A_ref) over det(A_ref'A_ref), unseen motions left out; these, at trial_, go to unseen_.
///
/// With N the unseen motions, A N = 0, and M = A_ref'A + s N_ref N_ref',
///
///     det M = s^k det(N_ref'N) det(A_ref'A on the others),   M^-1 s N_ref = N (N_ref'N)^-1,
///
/// so that one elimination gives the determinant and N.
double HandTracker::BranchDeterminant() noexcept {
  const int n = static_cast<int>(A_.cols()), rows = static_cast<int>(A_.rows());
  for (int j = 0; j < n; ++j) {
    for (int i = 0; i < n; ++i) {
      product_.data()[j * n + i] =
          DotOfDouble4(A_.data() + i * rows, A_reference_.data() + j * rows, rows);
    }
  }
  const bool some_unseen = unseen_.cols() > 0;
  if (some_unseen) {
    product_.transposeInPlace();
    AddUnseen(unseen_reference_);
    unseen_ = unseen_weight_ * unseen_reference_;
  }
  product_.diagonal().array() += kFloor * product_.diagonal().cwiseAbs().maxCoeff();
  double log = 0;
  const int sign = EliminateForSign(product_, unseen_, &log);
  if (some_unseen && sign == 0) unseen_ = unseen_reference_;
  if (some_unseen && sign != 0) {
    BackSubstitute(product_, unseen_);
    log += Orthonormalise(unseen_);
  }
  return sign * std::exp(log - log_reference_);
}

// product_ += s N N'
void HandTracker::AddUnseen(const MatrixXd& N) noexcept {
  for (Eigen::Index k = 0; k < N.cols(); ++k) {
    for (Eigen::Index j = 0; j < N.rows(); ++j) {
      product_.col(j) += unseen_weight_ * N(j, k) * N.col(k);
    }
  }
}

/// The motion that hand and loops resist least at trial_, but for what they do not see anywhere, by
/// inverse iteration on A'A: step_, of size kBeside.
void HandTracker::FindLeastStiffDirection() noexcept {
  product_ = A_.transpose().lazyProduct(A_);
  AddUnseen(unseen_);
  product_.diagonal().array() += kFloor * product_.diagonal().maxCoeff();
  normal_.compute(product_);
  step_ = VectorXd::LinSpaced(step_.size(), 1, 2);
  for (int i = 0; i < kInverseIterations; ++i) {
    normal_.solveInPlace(step_);
    step_ *= kBeside / step_.lpNorm<Eigen::Infinity>();
  }
}

/// trial_ goes from origin_ by `size` soft motions. Whether the loops close there, on the branch.
bool HandTracker::TryBeside(double size) noexcept {
  dq_ = size * step_;
  problem_.Plus(origin_, dq_, &trial_);
  Close();
  StackJacobians();
  determinant_ = BranchDeterminant();
  return IsClosed() && determinant_ > 0 && WithinLimits();
}

/// From a pose in the dead zone to its side.
bool HandTracker::OffsetFromSingularity() noexcept {
  origin_ = trial_;
  FindLeastStiffDirection();
  return TryBeside(1) || TryBeside(-1);
}

/// trial_ is beyond a singular pose. Where the soft motion leads across it, the hand's poses are
/// folded there: each is reached from both sides, at about the same distance, since the determinant
/// is linear; trial_ moves to the mirror image on the branch. Where the soft motion leads along the
/// singular poses (a wrist whose outer axes are in line, a leg in line with its first axis), this
/// side has no other pose for the hand, and the way on is a smooth one; trial_ stays.
HandTracker::Beyond HandTracker::FindMirrorImage() noexcept {
  origin_ = trial_;
  const double beyond = determinant_;
  FindLeastStiffDirection();
  TryBeside(1);
  const double size = -2 * beyond / (determinant_ - beyond);
  if (std::abs(size) * kBeside <= options_.max_move) {
    return TryBeside(size) ? Beyond::kTurningBack : Beyond::kUnknown;
  }
  trial_ = origin_;
  const bool near = (trial_ - q_).lpNorm<Eigen::Infinity>() <= options_.max_move;
  const bool beyond_still = Judge() == TrackStatus::kJump;
  return near && beyond_still && IsClosed() ? Beyond::kPassable : Beyond::kUnknown;
}

bool HandTracker::WithinLimits() const noexcept {
  for (const Bound& bound : problem_.bounds()) {
    const double value = trial_[bound.coordinate];
    if (value < bound.lower || value > bound.upper) return false;
  }
  return true;
}

/// E P S P, P = 1 - N N' without the unseen motions N.
void HandTracker::ComputeCurvature(MatrixXd* S) noexcept {
  problem_.Curvature(q_, good_multipliers_, S);
  *S *= problem_.energy();
  for (Eigen::Index k = 0; k < unseen_.cols(); ++k) {
    const auto n = unseen_.col(k);
    step_ = S->lazyProduct(n);
    const double along = n.dot(step_);
    S->noalias() -= step_.lazyProduct(n.transpose());
    S->noalias() -= n.lazyProduct(step_.transpose());
    S->noalias() += along * n.lazyProduct(n.transpose());
  }
}

TrackStatus HandTracker::Accept(Progress progress) noexcept {
  good_multipliers_ = workspace_.multipliers;
  MoveToTrial();
  const bool arrived = progress == Progress::kArrived;
  ++(arrived ? summary_.followed : summary_.catching_up);
  return arrived ? TrackStatus::kFollowed : TrackStatus::kCatchingUp;
}

void HandTracker::MoveToTrial() noexcept {
  q_ = trial_;
  at_q_ = true;
  summary_.worst_closure = std::max(summary_.worst_closure, at_trial_.c.lpNorm<Eigen::Infinity>());
  const double behind = (q_ - q_reference_).cwiseAbs().maxCoeff();
  const bool near = determinant_ * std::exp(log_reference_ - log_best_) < kReferenceNear;
  const bool passed = determinant_ < 0;  // Beyond::kPassable
  if (passed || behind > (near ? kReferenceRange : kReferenceBehind)) SetReference();
}

/// The last good pose becomes the reference.
void HandTracker::SetReference() noexcept {
  q_reference_ = q_;
  A_reference_ = A_;
  unseen_reference_ = unseen_;
  log_reference_ = 0;
  log_reference_ = std::log(BranchDeterminant());
  log_best_ = std::max(log_best_, log_reference_);
}

TrackStatus HandTracker::Hold(TrackStatus why) noexcept {
  workspace_.multipliers = good_multipliers_;
  switch (why) {
    case TrackStatus::kDeadCentre:
      ++summary_.dead_centre;
      return why;
    case TrackStatus::kJump:
      ++summary_.jumps;
      return why;
    default:
      ++summary_.lost;
      return TrackStatus::kLost;
  }
}

}  // namespace vmech
