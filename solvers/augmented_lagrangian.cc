#include "vmech/solvers/augmented_lagrangian.h"

#include <algorithm>

#include "vmech/base/check_range.h"
#include "vmech/solvers/run.h"

namespace vmech {
namespace {

// A round that leaves more than this part of the constraint error calls for a larger weight.
constexpr double kSlow = 0.25;
constexpr double kWeightGrowth = 3;
// Rounds at the largest weight without progress after which nothing more is expected.
constexpr int kMaxFutileRounds = 5;

}  // namespace

void AugmentedLagrangianOptions::Validate() const {
  CheckRange("AugmentedLagrangianOptions", "weight", weight, 1, 1e6);
  CheckRange("AugmentedLagrangianOptions", "max_weight", max_weight, weight, 1e7);
  CheckRange("AugmentedLagrangianOptions", "damping", damping, 1e-14, 1);
  CheckRange("AugmentedLagrangianOptions", "max_step", max_step, 1e-12,
             std::numeric_limits<double>::infinity());
  stopping.Validate();
}

AugmentedLagrangianWorkspace::AugmentedLagrangianWorkspace(const ConstrainedLeastSquares& problem)
    : step(problem), multipliers(VectorXd::Zero(problem.sizes().constraints)) {}

StepReport Step(ConstrainedLeastSquares& problem, const AugmentedLagrangianOptions& options,
                VectorXd* x, AugmentedLagrangianWorkspace* workspace) noexcept {
  WeightedStep& step = workspace->step;
  StepReport report;
  step.ForgetScale();
  step.use_curvature = false;
  if (!step.Linearize(problem, *x, options.weight, workspace->multipliers)) return report;
  if (!step.Compute(problem, *x, options.damping, options.max_step)) return report;
  report.constraint_norm = step.at_x.c.norm();
  report.step_norm = step.dx.cwiseAbs().maxCoeff();
  const VectorXd& c_after = step.PredictConstraints();
  report.bias_bound = c_after.norm();
  workspace->multipliers += options.weight * options.weight * c_after;
  problem.Plus(*x, step.dx, x);
  report.ok = true;
  return report;
}

FastOutcome Solve(ConstrainedLeastSquares& problem, const AugmentedLagrangianOptions& options,
                  VectorXd* x, AugmentedLagrangianWorkspace* workspace) noexcept {
  WeightedStep& step = workspace->step;
  step.use_curvature = options.use_second_derivatives && problem.has_second_derivatives();
  const StoppingRule& rule = options.stopping;
  FastOutcome outcome{SolveStatus::kStalled};
  double lambda = options.weight, tolerance = 1e-2;
  double last_error = std::numeric_limits<double>::infinity();
  int futile_rounds = 0;
  while (futile_rounds < kMaxFutileRounds) {
    const double target = std::max(tolerance, rule.optimality_tolerance);
    const WeightedStep::Descent descent =
        step.Minimize(problem, lambda, workspace->multipliers, options.damping, options.max_step,
                      target, rule.max_iterations - outcome.iterations, x);
    outcome.iterations += descent.iterations;
    outcome.constraint_norm = step.at_x.c.lpNorm<Eigen::Infinity>();
    if (!descent.ok) return outcome;
    // mu += lambda^2 c: what was the gradient of phi is now that of the Lagrangian
    workspace->multipliers += lambda * lambda * step.at_x.c;
    const bool closed = outcome.constraint_norm <= rule.constraint_tolerance;
    if (closed && descent.stationary && target == rule.optimality_tolerance) {
      outcome.claim = SolveStatus::kConverged;
      return outcome;
    }
    if (outcome.iterations >= rule.max_iterations) {
      outcome.claim = SolveStatus::kIterationLimit;
      return outcome;
    }
    const bool slow = !closed && outcome.constraint_norm > kSlow * last_error;
    if (slow && lambda >= options.max_weight) ++futile_rounds;
    if (slow) lambda = std::min(kWeightGrowth * lambda, options.max_weight);
    last_error = outcome.constraint_norm;
    tolerance = closed ? 0 : 0.1 * tolerance;  // the multipliers are right: only x may not be yet
  }
  return outcome;
}

Summary Solve(ConstrainedLeastSquares& problem, const AugmentedLagrangianOptions& options,
              const VectorXd& x0) {
  options.Validate();
  const auto back_end = [&](CountedProblem& counted, VectorXd* x) {
    AugmentedLagrangianWorkspace workspace(counted);
    const FastOutcome fast = Solve(counted, options, x, &workspace);
    return Outcome{fast.claim, "the multiplier updates have ended", fast.iterations};
  };
  return Run("augmented_lagrangian", problem, options.stopping, x0, back_end);
}

}  // namespace vmech
