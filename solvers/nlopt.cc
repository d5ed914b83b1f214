#include "vmech/solvers/nlopt.h"

#include <nlopt.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "vmech/solvers/tangent_chart.h"

namespace vmech {
namespace {

struct DestroyOpt {
  void operator()(nlopt_opt_s* opt) const { nlopt_destroy(opt); }
};
using Opt = std::unique_ptr<nlopt_opt_s, DestroyOpt>;

Opt Create(nlopt_algorithm algorithm, int n) {
  return Opt(nlopt_create(algorithm, static_cast<unsigned>(n)));
}

VectorXd Vector(const double* y, unsigned n) {
  return Eigen::Map<const VectorXd>(y, n);
}

double Objective(unsigned n, const double* y, double* gradient, void* data) {
  TangentChart& chart = *static_cast<TangentChart*>(data);
  const double value = 0.5 * chart.At(Vector(y, n)).r.squaredNorm();
  if (gradient) Eigen::Map<VectorXd>(gradient, n) = chart.Gradient();
  return std::isfinite(value) ? value : HUGE_VAL;
}

void Constraints(unsigned m, double* c, unsigned n, const double* y, double* gradient, void* data) {
  const Linearization& at_y = static_cast<TangentChart*>(data)->At(Vector(y, n));
  Eigen::Map<VectorXd>(c, m) = at_y.c;
  if (gradient) {
    Eigen::Map<Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>>(gradient, m,
                                                                                       n) = at_y.C;
  }
}

void SetTolerances(nlopt_opt opt, double tolerance, int max_evaluations) {
  nlopt_set_xtol_rel(opt, tolerance);
  nlopt_set_ftol_rel(opt, tolerance);
  nlopt_set_maxeval(opt, max_evaluations);
}

Opt Configure(const NloptOptions& options, TangentChart& chart, int max_evaluations) {
  const int n = chart.num_variables();
  Opt opt = Create(NLOPT_LD_SLSQP, n);
  nlopt_set_min_objective(opt.get(), Objective, &chart);
  nlopt_set_lower_bounds(opt.get(), chart.lower.data());
  nlopt_set_upper_bounds(opt.get(), chart.upper.data());
  if (chart.num_constraints() > 0) {
    const VectorXd tolerance =
        VectorXd::Constant(chart.num_constraints(), 0.1 * options.stopping.constraint_tolerance);
    nlopt_add_equality_mconstraint(opt.get(), static_cast<unsigned>(chart.num_constraints()),
                                   Constraints, &chart, tolerance.data());
  }
  SetTolerances(opt.get(), options.tolerance, max_evaluations);
  return opt;
}

Outcome OutcomeOf(nlopt_result result, int evaluations) {
  const std::string message = std::string("NLopt: ") + nlopt_result_to_string(result);
  SolveStatus claim = SolveStatus::kStalled;
  if (result == NLOPT_MAXEVAL_REACHED) claim = SolveStatus::kIterationLimit;
  if (result > 0 && claim != SolveStatus::kIterationLimit) claim = SolveStatus::kConverged;
  return {claim, message, evaluations};
}

// Evaluations of NLopt that are worth one iteration of the stopping rule.
constexpr int kEvaluationsPerIteration = 20;

}  // namespace

void NloptOptions::Validate() const {
  CheckRange("NloptOptions", "tolerance", tolerance, 1e-17, 1e-3);
  stopping.Validate();
}

Summary Solve(ConstrainedLeastSquares& problem, const NloptOptions& options, const VectorXd& x0) {
  options.Validate();
  const auto in_chart = [&](TangentChart& chart, int max_iterations, VectorXd* y) {
    const Opt opt = Configure(options, chart, kEvaluationsPerIteration * max_iterations);
    *y = y->cwiseMax(chart.lower).cwiseMin(chart.upper);
    double value = 0;
    const nlopt_result result = nlopt_optimize(opt.get(), y->data(), &value);
    return OutcomeOf(result, nlopt_get_numevals(opt.get()) / kEvaluationsPerIteration + 1);
  };
  return Run("nlopt_slsqp", problem, options.stopping, x0,
             [&](CountedProblem& counted, VectorXd* x) {
               return SolveInCharts(counted, options.stopping, x, in_chart);
             });
}

}  // namespace vmech
