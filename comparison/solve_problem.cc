#include "vmech/comparison/solve_problem.h"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <vector>

#include "vmech/base/linear_algebra/linear_algebra.h"
#include "vmech/comparison/statistics.h"
#include "vmech/kinematics/inverse/configuration_distance.h"
#include "vmech/kinematics/inverse/hand_tracker.h"
#include "vmech/kinematics/loops/dimensionless_loops.h"
#include "vmech/kinematics/loops/mobility.h"
#include "vmech/kinematics/loops/unseen_motions.h"
#include "vmech/solvers/run.h"

namespace vmech {
namespace {

// Configurations that are nearer than this are the same: far above what a tolerance on e1 leaves at
// a pose that is nearly singular, far below the distance of two branches.
constexpr double kSameConfiguration = 1e-3;
constexpr double kJump = 10;    // of a path's own step
constexpr int kGivenUp = 5;     // targets in a row that are not reached: the path is lost
constexpr double kLong = 0.02;  // [s] of a solve whose time needs no repetition

Verdict VerdictOf(SolveStatus status) {
  switch (status) {
    case SolveStatus::kBiased:
      return Verdict::kBiased;
    case SolveStatus::kInfeasible:
      return Verdict::kInfeasible;
    case SolveStatus::kIterationLimit:
      return Verdict::kIterationLimit;
    case SolveStatus::kUnsuitable:
      return Verdict::kUnsuitable;
    case SolveStatus::kUnavailable:
      return Verdict::kUnavailable;
    case SolveStatus::kStalled:
    case SolveStatus::kConverged:
      return Verdict::kStalled;
    case SolveStatus::kFailed:
    case SolveStatus::kNotRun:
      break;
  }
  return Verdict::kFailed;
}

/// Smallest eigenvalue, over the largest magnitude, of the Hessian of the Lagrangian on the
/// directions that the constraints and the bounds that carry a multiplier leave free.
double LeastCurvature(ConstrainedLeastSquares& problem, const Summary& summary) {
  const ProblemSizes& sizes = problem.sizes();
  VectorXd r(sizes.residuals);
  MatrixXd J(sizes.residuals, sizes.tangents), S(sizes.tangents, sizes.tangents);
  MatrixXd C(sizes.constraints, sizes.tangents);
  problem.Evaluate(summary.x, &r, &J, nullptr, &C);
  problem.Curvature(summary.x, summary.multipliers, &S);
  for (size_t k = 0; k < problem.bounds().size(); ++k) {
    if (summary.bound_multipliers[k] == 0) continue;
    C.conservativeResize(C.rows() + 1, Eigen::NoChange);
    C.bottomRows(1).setZero();
    C(C.rows() - 1, problem.bounds()[k].tangent) = 1;
  }
  const MatrixXd Z = C.rows() == 0 ? MatrixXd(MatrixXd::Identity(sizes.tangents, sizes.tangents))
                                   : FindNullSpace(C, kRankTolerance).basis;
  if (Z.cols() == 0) return 0;
  const MatrixXd H = Z.transpose() * (J.transpose() * J + S) * Z;
  const VectorXd eigenvalues = Eigen::SelfAdjointEigenSolver<MatrixXd>(H).eigenvalues();
  return eigenvalues[0] / std::max(eigenvalues.cwiseAbs().maxCoeff(), 1e-300);
}

/// How far a configuration is from another one as the grasp tells it: after the motions that
/// neither hand nor loops see have brought it as near as they can, or `enough`.
double SeenDistance(Subject* subject, const VectorXd& q, const VectorXd& other, double enough) {
  const VectorXd nearest = NearestAlongUnseen(&subject->problem(), q, other, enough);
  return ConfigurationDistance(subject->tree(), nearest, other);
}

/// What came out of one solve, and what we measure of it.
class Judged {
 public:
  Judged(const Suite& suite, const Problem& problem, Subject* subject, size_t target,
         const Summary& summary)
      : suite_(suite), problem_(problem), subject_(*subject), target_(target), summary_(summary) {
    InverseKinematics& ik = subject_.problem();
    e1_ = ik.HandError(summary_.x);
    if (ik.grasp().kind == GraspKind::kPoint) e1_.tail<3>().setZero();
    distance_ = SeenDistance(subject, summary_.x, problem_.own[target_], kSameConfiguration);
  }

  const Summary& summary() const { return summary_; }
  bool feasible() const {
    return summary_.constraint_norm <= suite_.stopping.constraint_tolerance &&
           summary_.bound_violation <= suite_.stopping.constraint_tolerance;
  }
  bool reached() const {
    const double off =
        std::hypot(e1_.head<3>().norm() / subject_.tree().length, e1_.tail<3>().norm());
    return feasible() && off <= suite_.reach_tolerance;
  }

  Verdict verdict(TargetKind kind) const {
    constexpr double kSaddle = -1e-6;
    if (reached()) return Verdict::kSolved;
    const bool stationary =
        feasible() && summary_.kkt_error <= suite_.stopping.optimality_tolerance;
    if (stationary && LeastCurvature(subject_.problem(), summary_) < kSaddle) {
      return Verdict::kSaddle;
    }
    if (summary_.status != SolveStatus::kConverged) return VerdictOf(summary_.status);
    return kind == TargetKind::kUnreachable ? Verdict::kUnreachable : Verdict::kLocalMinimum;
  }

  std::string Message(Verdict verdict) const {
    const std::string off = fmt::format("{:.3g} m and {:.3g} rad off the target",
                                        e1_.head<3>().norm(), e1_.tail<3>().norm());
    switch (verdict) {
      case Verdict::kSolved:
        return "the target is reached";
      case Verdict::kUnreachable:
        return "the nearest pose, " + off;
      case Verdict::kLocalMinimum:
        return "a nearest pose of its neighbourhood, " + off;
      case Verdict::kSaddle:
        return "stationary but no minimum, " + off;
      default:
        return summary_.message;
    }
  }

  Branch branch(bool found) const {
    if (!found) return Branch::kUnknown;
    if (!problem_.determined) return Branch::kFree;
    return distance_ <= kSameConfiguration ? Branch::kOwn : Branch::kOther;
  }

  /// Adds counts and time, keeps the largest errors.
  void AddTo(Result* result) const {
    result->iterations += summary_.iterations;
    result->evaluations += summary_.evaluations;
    result->jacobian_evaluations += summary_.jacobian_evaluations;
    result->time += summary_.seconds;
    result->e1_position = std::max(result->e1_position, e1_.head<3>().norm());
    result->e1_rotation = std::max(result->e1_rotation, e1_.tail<3>().norm());
    result->e2 = std::max(result->e2, summary_.constraint_norm);
    result->kkt = std::max(result->kkt, summary_.kkt_error);
    result->distance = std::max(result->distance, distance_);
  }

 private:
  const Suite& suite_;
  const Problem& problem_;
  Subject& subject_;
  size_t target_;
  const Summary& summary_;
  Vector6d e1_ = Vector6d::Zero();
  double distance_ = 0;
};

/// Brings the grasp towards a target, from x0.
using Solver = std::function<Summary(const Posed& X_WH, const VectorXd& x0)>;

Solver SolverOf(Backend backend, const Suite& suite, Subject* subject) {
  return [=, &suite](const Posed& X_WH, const VectorXd& x0) {
    subject->problem().SetTarget(X_WH);
    return Solve(backend, subject->problem(), suite.stopping, x0);
  };
}

/// The fast path keeps its own configuration and multipliers from target to target.
Solver FastPathFrom(const VectorXd& q, const Suite& suite, Subject* subject) {
  auto tracker = std::make_shared<HandTracker>(subject->tree(), subject->problem().grasp(), q);
  return [=, &suite](const Posed& X_WH, const VectorXd&) {
    subject->problem().SetTarget(X_WH);
    return Run("hand_tracker", subject->problem(), suite.stopping, tracker->q(),
               [&](CountedProblem&, VectorXd* x) {
                 const TrackStatus status = tracker->Advance(X_WH);
                 *x = tracker->q();
                 return Outcome{SolveStatus::kStalled, std::string(NameOf(status)), 1};
               });
  };
}

void SolvePose(const Suite& suite, TargetKind kind, const Problem& problem, Subject* subject,
               const Solver& solve, Result* result) {
  const Summary summary = solve(problem.targets[0], problem.start);
  const Judged judged(suite, problem, subject, 0, summary);
  judged.AddTo(result);
  result->verdict = judged.verdict(kind);
  result->message = judged.Message(result->verdict);
  result->reached = judged.reached() ? 1 : 0;
  const bool found = result->verdict == Verdict::kSolved || Succeeded(*result, kind);
  result->branch = judged.branch(found);
  std::vector<double> times = {summary.seconds};
  while (static_cast<int>(times.size()) < suite.repetitions && summary.seconds < kLong &&
         result->verdict != Verdict::kUnavailable) {
    times.push_back(solve(problem.targets[0], problem.start).seconds);
  }
  result->time = MedianOf(times);
}

/// Counts what becomes of the targets of a path.
void FollowPath(const Suite& suite, const TargetBlock& block, const Problem& problem,
                Subject* subject, const Solver& solve, Result* result) {
  VectorXd x = problem.start;
  int since = 1;  // targets since the last one that was reached
  std::string trouble;
  for (size_t k = 0; k < problem.targets.size() && since <= kGivenUp; ++k) {
    const Summary summary = solve(problem.targets[k], x);
    const Judged judged(suite, problem, subject, k, summary);
    judged.AddTo(result);
    result->branch = judged.branch(judged.reached());
    if (summary.status == SolveStatus::kUnavailable) {
      result->verdict = Verdict::kUnavailable;
      result->message = summary.message;
      return;
    }
    if (!judged.reached()) {
      ++since;
      const Verdict verdict = judged.verdict(block.kind);
      if (!trouble.empty()) continue;
      trouble = fmt::format("; first at target {}: {}: {}", k + 1, NameOf(verdict),
                            judged.Message(verdict));
      continue;
    }
    ++result->reached;
    const double jump = kJump * since * block.step;
    if (problem.determined && SeenDistance(subject, summary.x, x, jump) > jump) ++result->jumps;
    since = 1;
    x = summary.x;
  }
  const bool all = result->reached == result->targets;
  result->verdict = !all ? Verdict::kLost : result->jumps > 0 ? Verdict::kJumped : Verdict::kSolved;
  result->message = fmt::format("{} of {} targets reached, {} jumps{}", result->reached,
                                result->targets, result->jumps, trouble);
}

}  // namespace

Result SolveProblem(const Suite& suite, const ProblemId& id, const Problem& problem,
                    Subject* subject, SolverEntry solver) {
  Result result;
  result.problem = id;
  result.solver = solver;
  if (!problem.defect.empty()) {
    result.verdict = Verdict::kNotPosed;
    result.message = problem.defect;
    return result;
  }
  const TargetBlock& block = suite.blocks[id.block];
  result.targets = static_cast<int>(problem.targets.size());
  const Solver solve = solver.backend() ? SolverOf(*solver.backend(), suite, subject)
                                        : FastPathFrom(problem.start, suite, subject);
  if (block.is_path()) {
    FollowPath(suite, block, problem, subject, solve, &result);
  } else {
    SolvePose(suite, block.kind, problem, subject, solve, &result);
  }
  return result;
}

}  // namespace vmech
