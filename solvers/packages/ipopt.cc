#include "vmech/solvers/backends/ipopt.h"

#include <IpIpoptApplication.hpp>
#include <IpSolveStatistics.hpp>
#include <IpTNLP.hpp>
#include <algorithm>
#include <cmath>
#include <mutex>

#include "vmech/solvers/backends/package.h"
#include "vmech/solvers/packages/ipopt_mutex.h"
#include "vmech/solvers/packages/tangent_chart.h"

namespace vmech {
namespace {

using Ipopt::Index;
using Ipopt::Number;

Eigen::Map<const VectorXd> Vector(const Number* data, Index n) {
  return {data, n};
}

// Ipopt writes "infinity" as 1e19 and beyond.
Number IpoptBound(double value) {
  return std::clamp(value, -2e19, 2e19);
}

class ChartNlp final : public Ipopt::TNLP {
 public:
  ChartNlp(TangentChart& chart, VectorXd* y) : chart_(chart), y_(y) {}

  bool get_nlp_info(Index& n, Index& m, Index& nnz_jac_g, Index& nnz_h_lag,
                    IndexStyleEnum& index_style) override {
    n = chart_.num_variables();
    m = chart_.num_constraints();
    nnz_jac_g = n * m;
    nnz_h_lag = n * (n + 1) / 2;
    index_style = C_STYLE;
    return true;
  }

  bool get_bounds_info(Index n, Number* x_l, Number* x_u, Index m, Number* g_l,
                       Number* g_u) override {
    for (Index i = 0; i < n; ++i) {
      x_l[i] = IpoptBound(chart_.lower[i]);
      x_u[i] = IpoptBound(chart_.upper[i]);
    }
    std::fill(g_l, g_l + m, 0.0);
    std::fill(g_u, g_u + m, 0.0);
    return true;
  }

  bool get_starting_point(Index n, bool, Number* x, bool, Number*, Number*, Index, bool,
                          Number*) override {
    std::fill(x, x + n, 0.0);
    return true;
  }

  bool eval_f(Index n, const Number* x, bool, Number& value) override {
    value = 0.5 * chart_.At(Vector(x, n)).r.squaredNorm();
    return std::isfinite(value);
  }

  bool eval_grad_f(Index n, const Number* x, bool, Number* gradient) override {
    chart_.At(Vector(x, n));
    Eigen::Map<VectorXd>(gradient, n) = chart_.Gradient();
    return true;
  }

  bool eval_g(Index n, const Number* x, bool, Index m, Number* g) override {
    Eigen::Map<VectorXd>(g, m) = chart_.At(Vector(x, n)).c;
    return Vector(g, m).allFinite();
  }

  bool eval_jac_g(Index n, const Number* x, bool, Index m, Index, Index* rows, Index* columns,
                  Number* values) override {
    if (values) {
      Eigen::Map<MatrixXd>(values, m, n) = chart_.At(Vector(x, n)).C;
      return true;
    }
    for (Index k = 0; k < n * m; ++k) rows[k] = k % m, columns[k] = k / m;
    return true;
  }

  bool eval_h(Index n, const Number* x, bool, Number sigma, Index m, const Number* lambda, bool,
              Index, Index* rows, Index* columns, Number* values) override {
    MatrixXd H;
    if (values) {
      chart_.At(Vector(x, n));
      // In restoration Ipopt asks for sigma = 0: the constraints alone.
      H = sigma > 0 ? chart_.Hessian(sigma, Vector(lambda, m))
                    : MatrixXd(chart_.Hessian(1, Vector(lambda, m)) -
                               chart_.Hessian(1, VectorXd::Zero(m)));
    }
    for (Index j = 0, k = 0; j < n; ++j) {
      for (Index i = j; i < n; ++i, ++k) {
        if (values)
          values[k] = H(i, j);
        else
          rows[k] = i, columns[k] = j;
      }
    }
    return true;
  }

  void finalize_solution(Ipopt::SolverReturn, Index n, const Number* x, const Number*,
                         const Number*, Index, const Number*, const Number*, Number,
                         const Ipopt::IpoptData*, Ipopt::IpoptCalculatedQuantities*) override {
    *y_ = Vector(x, n);
  }

 private:
  TangentChart& chart_;
  VectorXd* y_;
};

// Registering some three hundred options takes Ipopt longer than a warm solve: the application is
// kept, and never deleted, as Ipopt's own libraries may be gone by then.
Ipopt::IpoptApplication& KeptApplication() {
  static auto* const kept =
      new Ipopt::SmartPtr<Ipopt::IpoptApplication>(new Ipopt::IpoptApplication(false));
  return **kept;
}

void SetOptions(const IpoptOptions& options, int max_iterations,
                Ipopt::IpoptApplication* application) {
  const auto& list = application->Options();
  list->SetIntegerValue("print_level", 0);
  list->SetStringValue("sb", "yes");
  list->SetStringValue("linear_solver", "mumps");
  list->SetStringValue("nlp_scaling_method", "none");
  list->SetStringValue("fixed_variable_treatment", "make_parameter");
  list->SetNumericValue("bound_relax_factor", 0);
  list->SetNumericValue("tol", options.tolerance);
  list->SetNumericValue("constr_viol_tol", options.stopping.constraint_tolerance);
  list->SetIntegerValue("acceptable_iter", 0);
  list->SetNumericValue("mu_init", options.initial_barrier);
  list->SetIntegerValue("max_iter", max_iterations);
  application->Initialize("");
}

Outcome OutcomeOf(Ipopt::ApplicationReturnStatus status) {
  switch (status) {
    case Ipopt::Solve_Succeeded:
    case Ipopt::Solved_To_Acceptable_Level:
      return {SolveStatus::kConverged, "Ipopt: solved"};
    case Ipopt::Maximum_Iterations_Exceeded:
      return {SolveStatus::kIterationLimit, "Ipopt: iterations are spent"};
    case Ipopt::Infeasible_Problem_Detected:
      return {SolveStatus::kStalled, "Ipopt: infeasible"};
    case Ipopt::Not_Enough_Degrees_Of_Freedom:
      return {SolveStatus::kUnsuitable, "Ipopt: fewer free coordinates than constraints"};
    default:
      return {SolveStatus::kStalled,
              "Ipopt: stopped with code " + std::to_string(static_cast<int>(status))};
  }
}

Outcome SolveByIpopt(CountedProblem& problem, const IpoptOptions& options, VectorXd* x) {
  const auto in_chart = [&](TangentChart& chart, int max_iterations, VectorXd* y) {
    const std::lock_guard lock(IpoptMutex());
    Ipopt::IpoptApplication& application = KeptApplication();
    SetOptions(options, max_iterations, &application);
    const Ipopt::SmartPtr<Ipopt::TNLP> nlp = new ChartNlp(chart, y);
    Outcome outcome = OutcomeOf(application.OptimizeTNLP(nlp));
    const auto statistics = application.Statistics();
    outcome.iterations = Ipopt::IsValid(statistics) ? statistics->IterationCount() : 0;
    return outcome;
  };
  return SolveInCharts(problem, options.stopping, x, in_chart);
}

}  // namespace
}  // namespace vmech

extern "C" {
vmech::PackageFunction<vmech::IpoptOptions> vmech_solve = vmech::SolveByIpopt;
}
