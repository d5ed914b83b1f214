#include "vmech/solvers/backends/nlopt.h"

#include <nlopt.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>

#include "vmech/solvers/backends/package.h"
#include "vmech/solvers/packages/tangent_chart.h"

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

// NLopt's algorithms compare numbers and never ask whether they are any.
constexpr double kHuge = 1e100;
// Long moves per variable after which COBYLA is stopped: some ninety rounds of AUGLAG.
constexpr int kLongMoves = 60;
// The least that COBYLA can be asked for: with differences of values it sees no smaller |c|.
constexpr double kCobylaClosure = 1e-6;

/// The problem in one chart as NLopt's callbacks see it.
struct ChartFunctions {
  explicit ChartFunctions(TangentChart& c) : chart(c) {}

  TangentChart& chart;
  nlopt_opt opt = nullptr;
  double long_move = kHuge;  ///< half the first step of COBYLA
  int long_moves_left = 0;
  VectorXd last;

  // Each round of AUGLAG begins with moves of COBYLA's first step, and may raise the penalty
  // tenfold, up to infinity; COBYLA never returns from infinite values. So stop long before.
  void CountRounds(const VectorXd& y) {
    if (last.size() > 0 && (y - last).norm() > long_move && --long_moves_left < 0) {
      nlopt_force_stop(opt);
    }
    last = y;
  }
};

double Objective(unsigned n, const double* y, double* gradient, void* data) {
  ChartFunctions& functions = *static_cast<ChartFunctions*>(data);
  TangentChart& chart = functions.chart;
  functions.CountRounds(Vector(y, n));
  const double value = 0.5 * chart.At(Vector(y, n)).r.squaredNorm();
  if (gradient) Eigen::Map<VectorXd>(gradient, n) = chart.Gradient();
  return std::isfinite(value) ? value : kHuge;
}

void Constraints(unsigned m, double* c, unsigned n, const double* y, double* gradient, void* data) {
  const Linearization& at_y = static_cast<ChartFunctions*>(data)->chart.At(Vector(y, n));
  for (unsigned i = 0; i < m; ++i) c[i] = std::isfinite(at_y.c[i]) ? at_y.c[i] : kHuge;
  if (gradient) {
    Eigen::Map<Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>>(gradient, m,
                                                                                       n) = at_y.C;
  }
}

// Bounds as inequalities g <= 0, two a variable; what is unbounded is far from its bound.
void BoundsAsInequalities(unsigned m, double* g, unsigned n, const double* y, double*, void* data) {
  const TangentChart& chart = static_cast<ChartFunctions*>(data)->chart;
  for (unsigned i = 0; i < n && i < m; ++i) {
    g[i] = std::max(chart.lower[i] - y[i], -kHuge);
    g[n + i] = std::max(y[i] - chart.upper[i], -kHuge);
  }
}

struct Limits {
  int evaluations;
  double seconds;
};

void SetLimits(nlopt_opt opt, const NloptOptions& options, const Limits& limits) {
  const bool cobyla = nlopt_get_algorithm(opt) == NLOPT_LN_COBYLA;
  nlopt_set_xtol_rel(opt, options.tolerance);
  nlopt_set_ftol_rel(opt, cobyla ? 0 : options.tolerance);
  if (cobyla) nlopt_set_xtol_abs1(opt, options.final_step);
  if (cobyla) nlopt_set_initial_step1(opt, options.initial_step);
  nlopt_set_maxeval(opt, limits.evaluations);
  nlopt_set_maxtime(opt, limits.seconds);
}

void AddConstraints(const NloptOptions& options, ChartFunctions* functions) {
  const TangentChart& chart = functions->chart;
  const int n = chart.num_variables(), m = chart.num_constraints();
  const bool cobyla = options.method == NloptMethod::kAuglagCobyla;
  double closure = 0.1 * options.stopping.constraint_tolerance;
  if (cobyla) closure = std::max(closure, kCobylaClosure);
  if (m > 0) {
    nlopt_add_equality_mconstraint(functions->opt, static_cast<unsigned>(m), Constraints, functions,
                                   VectorXd::Constant(m, closure).eval().data());
  }
  if (cobyla) {
    nlopt_add_inequality_mconstraint(functions->opt, static_cast<unsigned>(2 * n),
                                     BoundsAsInequalities, functions,
                                     VectorXd::Constant(2 * n, closure).eval().data());
  } else {
    nlopt_set_lower_bounds(functions->opt, chart.lower.data());
    nlopt_set_upper_bounds(functions->opt, chart.upper.data());
  }
}

nlopt_algorithm InnerAlgorithm(NloptMethod method) {
  if (method == NloptMethod::kAuglagCobyla) return NLOPT_LN_COBYLA;
  return method == NloptMethod::kAuglagMma ? NLOPT_LD_MMA : NLOPT_LD_LBFGS;
}

Opt Configure(const NloptOptions& options, const Limits& limits, ChartFunctions* functions) {
  const int n = functions->chart.num_variables();
  const bool slsqp = options.method == NloptMethod::kSlsqp;
  Opt opt = Create(slsqp ? NLOPT_LD_SLSQP : NLOPT_AUGLAG, n);
  functions->opt = opt.get();
  nlopt_set_min_objective(opt.get(), Objective, functions);
  AddConstraints(options, functions);
  SetLimits(opt.get(), options, limits);
  if (slsqp) return opt;
  const Opt inner = Create(InnerAlgorithm(options.method), n);
  SetLimits(inner.get(), options, limits);
  nlopt_set_local_optimizer(opt.get(), inner.get());  // copies
  return opt;
}

Outcome OutcomeOf(nlopt_result result, int evaluations) {
  const std::string message = std::string("NLopt: ") + nlopt_result_to_string(result);
  SolveStatus claim = SolveStatus::kStalled;
  if (result == NLOPT_MAXEVAL_REACHED || result == NLOPT_MAXTIME_REACHED) {
    claim = SolveStatus::kIterationLimit;
  }
  if (result > 0 && claim != SolveStatus::kIterationLimit) claim = SolveStatus::kConverged;
  return {claim, message, evaluations};
}

// AUGLAG gives a closed start back unless it ends closed itself: it begins a little beside.
void StepAside(VectorXd* y) {
  constexpr double kAside = 1e-3;
  for (int i = 0; i < y->size(); ++i) (*y)[i] += kAside * std::sin(1 + 2.3 * i);
}

// Evaluations of NLopt that are worth one iteration of the stopping rule.
constexpr int kEvaluationsPerIteration = 20;

Outcome SolveByNlopt(CountedProblem& problem, const NloptOptions& options, VectorXd* x) {
  const auto start = std::chrono::steady_clock::now();
  const bool auglag = options.method != NloptMethod::kSlsqp;
  bool first = true;
  const auto in_chart = [&](TangentChart& chart, int max_iterations, VectorXd* y) {
    const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;
    const double left = options.max_seconds - elapsed.count();
    if (left <= 0) return Outcome{SolveStatus::kIterationLimit, "the time is spent"};
    ChartFunctions functions(chart);
    if (options.method == NloptMethod::kAuglagCobyla) {
      functions.long_move = 0.5 * options.initial_step;
      functions.long_moves_left = kLongMoves * (chart.num_variables() + 2);
    }
    const Opt opt =
        Configure(options, {kEvaluationsPerIteration * max_iterations, left}, &functions);
    if (auglag && first) StepAside(y);
    first = false;
    *y = y->cwiseMax(chart.lower).cwiseMin(chart.upper);
    double value = 0;
    const nlopt_result result = nlopt_optimize(opt.get(), y->data(), &value);
    return OutcomeOf(result, nlopt_get_numevals(opt.get()) / kEvaluationsPerIteration + 1);
  };
  return SolveInCharts(problem, options.stopping, x, in_chart);
}

}  // namespace
}  // namespace vmech

extern "C" {
vmech::PackageFunction<vmech::NloptOptions> vmech_solve = vmech::SolveByNlopt;
}
