#include "vmech/solvers/run.h"

#include <fmt/format.h>

#include <chrono>
#include <stdexcept>

#include "vmech/solvers/optimality.h"

namespace vmech {
namespace {

// Below this slope |c| is taken as stationary; a zero that is merely not reached yet has a slope
// of order one.
constexpr double kStationarySlope = 1e-4;

void CheckStart(const ConstrainedLeastSquares& problem, const VectorXd& x0) {
  if (x0.size() != problem.sizes().coordinates) {
    throw std::invalid_argument(fmt::format("the start has {} coordinates, the problem {}",
                                            x0.size(), problem.sizes().coordinates));
  }
  if (!x0.allFinite()) throw std::invalid_argument("the start holds values that are not finite");
}

Outcome Call(const BackEnd& back_end, CountedProblem& problem, VectorXd* x) {
  try {
    return back_end(problem, x);
  } catch (const std::exception& error) {
    return {SolveStatus::kFailed, error.what()};
  }
}

void Verdict(const StoppingRule& rule, const Optimality& at_x, bool curves_upwards,
             const Outcome& outcome, Summary* summary) {
  const bool feasible = at_x.constraint_norm <= rule.constraint_tolerance &&
                        at_x.bound_violation <= rule.constraint_tolerance;
  if (feasible && at_x.kkt_error <= rule.optimality_tolerance) {
    summary->status = curves_upwards ? SolveStatus::kConverged : SolveStatus::kStalled;
    summary->message = curves_upwards ? "a constrained minimum"
                                      : "a saddle point or maximum: the gradient vanishes, but the "
                                        "objective falls to both sides";
  } else if (!feasible && at_x.constraint_norm > rule.constraint_tolerance &&
             at_x.infeasibility_slope < kStationarySlope) {
    summary->status = SolveStatus::kInfeasible;
    summary->message = fmt::format(
        "the constraints cannot be met nearby: |c| has a minimum of {:.3e}", at_x.constraint_norm);
  } else if (outcome.claim == SolveStatus::kConverged) {
    summary->status = SolveStatus::kStalled;
    summary->message = "the back end is content, the stopping rule is not: " + outcome.message;
  } else {
    summary->status = outcome.claim;
    summary->message = outcome.message;
  }
}

void Judge(ConstrainedLeastSquares& problem, const StoppingRule& rule, const Outcome& outcome,
           Summary* summary) {
  Linearization at_x(problem.sizes());
  at_x.Evaluate(problem, summary->x);
  if (!at_x.AllFinite()) {
    summary->status = SolveStatus::kFailed;
    summary->message = "the problem is not defined at the returned point";
    return;
  }
  Optimality optimality = MeasureOptimality(problem.bounds(), summary->x, at_x);
  summary->objective = optimality.objective;
  summary->constraint_norm = optimality.constraint_norm;
  summary->bound_violation = optimality.bound_violation;
  summary->kkt_error = optimality.kkt_error;
  const bool curves_upwards = CurvesUpwards(problem, summary->x, at_x, optimality.multipliers);
  Verdict(rule, optimality, curves_upwards, outcome, summary);
  summary->multipliers = std::move(optimality.multipliers);
  summary->bound_multipliers = std::move(optimality.bound_multipliers);
}

}  // namespace

Summary Run(std::string_view solver, ConstrainedLeastSquares& problem, const StoppingRule& rule,
            const VectorXd& x0, const BackEnd& back_end) {
  rule.Validate();
  CheckStart(problem, x0);
  Summary summary;
  summary.solver = solver;
  summary.x = x0;
  CountedProblem counted(problem);

  const auto start = std::chrono::steady_clock::now();
  Outcome outcome = Call(back_end, counted, &summary.x);
  const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;

  if (!summary.x.allFinite()) {
    summary.x = x0;
    outcome.claim = SolveStatus::kFailed;
    outcome.message = "the back end left the finite numbers; this is the start";
  }
  summary.seconds = elapsed.count();
  summary.iterations = outcome.iterations;
  summary.evaluations = counted.evaluations;
  summary.jacobian_evaluations = counted.jacobian_evaluations;
  summary.bias_bound = outcome.bias_bound;
  Judge(problem, rule, outcome, &summary);
  return summary;
}

}  // namespace vmech
