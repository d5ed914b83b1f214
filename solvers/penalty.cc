#include "vmech/solvers/penalty.h"

#include "vmech/base/check_range.h"
#include "vmech/solvers/run.h"

namespace vmech {

void PenaltyOptions::Validate() const {
  CheckRange("PenaltyOptions", "weight", weight, 1, 1e6);
  CheckRange("PenaltyOptions", "damping", damping, 1e-14, 1);
  CheckRange("PenaltyOptions", "max_step", max_step, 1e-12,
             std::numeric_limits<double>::infinity());
  stopping.Validate();
}

PenaltyWorkspace::PenaltyWorkspace(const ConstrainedLeastSquares& problem)
    : step(problem), no_multipliers(VectorXd::Zero(problem.sizes().constraints)) {}

StepReport Step(ConstrainedLeastSquares& problem, const PenaltyOptions& options, VectorXd* x,
                PenaltyWorkspace* workspace) noexcept {
  WeightedStep& step = workspace->step;
  StepReport report;
  step.ForgetScale();
  if (!step.Linearize(problem, *x, options.weight, workspace->no_multipliers)) return report;
  if (!step.Compute(problem, *x, options.damping, options.max_step)) return report;
  report.constraint_norm = step.at_x.c.norm();
  report.step_norm = step.dx.cwiseAbs().maxCoeff();
  report.bias_bound =
      step.PredictConstraints().norm();  // lambda^2 (c + C dx) is the multiplier estimate
  problem.Plus(*x, step.dx, x);
  report.ok = true;
  return report;
}

FastOutcome Solve(ConstrainedLeastSquares& problem, const PenaltyOptions& options, VectorXd* x,
                  PenaltyWorkspace* workspace) noexcept {
  WeightedStep& step = workspace->step;
  const WeightedStep::Descent descent = step.Minimize(
      problem, options.weight, workspace->no_multipliers, options.damping, options.max_step,
      options.stopping.optimality_tolerance, options.stopping.max_iterations, x);
  FastOutcome outcome;
  outcome.iterations = descent.iterations;
  outcome.constraint_norm = step.at_x.c.lpNorm<Eigen::Infinity>();
  outcome.bias_bound = step.at_x.c.norm();  // lambda^2 c is the multiplier estimate
  outcome.claim = descent.stationary ? SolveStatus::kBiased
                  : descent.ok       ? SolveStatus::kIterationLimit
                                     : SolveStatus::kStalled;
  return outcome;
}

Summary Solve(ConstrainedLeastSquares& problem, const PenaltyOptions& options, const VectorXd& x0) {
  options.Validate();
  return Run("penalty", problem, options.stopping, x0, [&](CountedProblem& counted, VectorXd* x) {
    PenaltyWorkspace workspace(counted);
    const FastOutcome fast = Solve(counted, options, x, &workspace);
    return Outcome{fast.claim, "the constraints stay open by multiplier / lambda^2",
                   fast.iterations, fast.bias_bound};
  });
}

}  // namespace vmech
