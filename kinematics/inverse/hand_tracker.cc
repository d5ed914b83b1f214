#include "vmech/kinematics/inverse/hand_tracker.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "vmech/base/check_range.h"
#include "vmech/base/linear_algebra/signed_elimination.h"
#include "vmech/kinematics/inverse/configuration_distance.h"
#include "vmech/kinematics/loops/unseen_motions.h"
#include "vmech/kinematics/tree/validity.h"

namespace vmech {
namespace {

/// |BranchDeterminant| below which a pose is in the dead zone: nearly at a dead centre, on one side
/// or the other.
constexpr double kDeadZone = 1e-3;
/// How far a pose in the dead zone is moved back to its side [rad or m].
constexpr double kBeside = 2e-3;
/// The reference moves on when it is so far behind [rad or m]; near a dead centre it stays back as
/// long as it tells something.
constexpr double kReferenceBehind = 0.05, kReferenceRange = 0.2;
/// A step that is longer than this part of the one before calls for second derivatives.
constexpr double kSlow = 0.02;
/// After a step as long as this at most [rad or m], the next may take the same derivatives.
constexpr double kShort = 1e-2;
/// ..if it is shorter by this.
constexpr double kContraction = 0.25;
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
      branch_(problem_.sizes().residuals + tree.rows, tree.nv),
      q_reference_(q),
      soft_(tree.nv),
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
  branch_.Begin(at_trial_.J, at_trial_.C, UnseenVelocities(&problem_, q));
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
  if (!at_trial_.AllFinite()) return TrackStatus::kLost;
  branch_.Take(at_trial_.J, at_trial_.C);
  if (std::abs(branch_.value()) < kDeadZone) return TrackStatus::kDeadCentre;
  if (branch_.value() < 0) return TrackStatus::kJump;
  return IsClosed() ? TrackStatus::kFollowed : TrackStatus::kLost;
}

bool HandTracker::IsClosed() const noexcept {
  return at_trial_.c.lpNorm<Eigen::Infinity>() <= options_.closure_tolerance;
}

/// trial_ goes from origin_ by `size` of the soft motion. Whether the loops close there, on the
/// branch.
bool HandTracker::TryBeside(double size) noexcept {
  dq_ = size * soft_;
  problem_.Plus(origin_, dq_, &trial_);
  Close();
  branch_.Take(at_trial_.J, at_trial_.C);
  return IsClosed() && branch_.value() > 0 && WithinLimits();
}

/// From a pose in the dead zone to its side.
bool HandTracker::OffsetFromSingularity() noexcept {
  origin_ = trial_;
  branch_.FindSoftMotion(&soft_);
  return TryBeside(kBeside) || TryBeside(-kBeside);
}

/// trial_ is beyond a singular pose. Where the soft motion leads across it, the hand's poses are
/// folded there: each is reached from both sides, at about the same distance, since the determinant
/// is linear; trial_ moves to the mirror image on the branch. Where the soft motion leads along the
/// singular poses (a wrist whose outer axes are in line, a leg in line with its first axis), this
/// side has no other pose for the hand, and the way on is a smooth one; trial_ stays.
HandTracker::Beyond HandTracker::FindMirrorImage() noexcept {
  origin_ = trial_;
  const double beyond = branch_.value();
  branch_.FindSoftMotion(&soft_);
  TryBeside(kBeside);
  const double size = -2 * kBeside * beyond / (branch_.value() - beyond);
  if (std::abs(size) <= options_.max_move) {
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
  for (Eigen::Index k = 0; k < branch_.unseen().cols(); ++k) {
    const auto n = branch_.unseen().col(k);
    dq_ = S->lazyProduct(n);
    const double along = n.dot(dq_);
    S->noalias() -= dq_.lazyProduct(n.transpose());
    S->noalias() -= n.lazyProduct(dq_.transpose());
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
  const double most = branch_.IsNearDeadCentre() ? kReferenceRange : kReferenceBehind;
  const bool passed = branch_.value() < 0;  // Beyond::kPassable
  if (!passed && behind <= most) return;
  q_reference_ = q_;
  branch_.SetReference();
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
