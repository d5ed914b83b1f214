#include <IpIpoptApplication.hpp>
#include <IpTNLP.hpp>
#include <algorithm>
#include <mutex>
#include <string>

#include "vmech/solvers/packages/ipopt_mutex.h"
#include "vmech/solvers/programs/scaled_program.h"

namespace vmech {
namespace {

using Ipopt::Index;
using Ipopt::Number;

/// A program in variables from 0 to 1, of which Ipopt sees values and slopes. Where it is not
/// defined, Ipopt is told so and takes a shorter step.
class ProgramNlp final : public Ipopt::TNLP {
 public:
  ProgramNlp(ScaledProgram& program, const ProgramOptions& options, const VectorXd& u)
      : program_(program), options_(options), u_(u) {}

  bool get_nlp_info(Index& n, Index& m, Index& nnz_jac_g, Index& nnz_h_lag,
                    IndexStyleEnum& index_style) override {
    n = program_.variables();
    m = program_.constraints();
    nnz_jac_g = n * m;
    nnz_h_lag = 0;
    index_style = C_STYLE;
    return true;
  }

  bool get_bounds_info(Index n, Number* x_l, Number* x_u, Index m, Number* g_l,
                       Number* g_u) override {
    constexpr double kNone = -2e19;
    std::fill(x_l, x_l + n, 0.0);
    std::fill(x_u, x_u + n, 1.0);
    std::fill(g_l, g_l + m, kNone);
    std::fill(g_u, g_u + m, -0.5 * program_.feasibility());
    return true;
  }

  bool get_starting_point(Index n, bool, Number* x, bool, Number*, Number*, Index, bool,
                          Number*) override {
    Eigen::Map<VectorXd>(x, n) = u_;
    return true;
  }

  bool eval_f(Index n, const Number* x, bool, Number& value) override {
    value = At(n, x).f;
    return program_.At(u_).defined;
  }

  bool eval_grad_f(Index n, const Number* x, bool, Number* gradient) override {
    Eigen::Map<VectorXd>(gradient, n) = At(n, x).df;
    return program_.At(u_).defined;
  }

  bool eval_g(Index n, const Number* x, bool, Index m, Number* g) override {
    Eigen::Map<VectorXd>(g, m) = At(n, x).g;
    return program_.At(u_).defined;
  }

  bool eval_jac_g(Index n, const Number* x, bool, Index m, Index, Index* rows, Index* columns,
                  Number* values) override {
    if (values != nullptr) {
      Eigen::Map<MatrixXd>(values, m, n) = At(n, x).dg;
      return program_.At(u_).defined;
    }
    for (Index k = 0; k < n * m; ++k) rows[k] = k % m, columns[k] = k / m;
    return true;
  }

  bool intermediate_callback(Ipopt::AlgorithmMode, Index, Number, Number, Number, Number, Number,
                             Number, Number, Number, Index, const Ipopt::IpoptData*,
                             Ipopt::IpoptCalculatedQuantities*) override {
    return program_.evaluations() < options_.max_evaluations;
  }

  void finalize_solution(Ipopt::SolverReturn, Index, const Number*, const Number*, const Number*,
                         Index, const Number*, const Number*, Number, const Ipopt::IpoptData*,
                         Ipopt::IpoptCalculatedQuantities*) override {}

 private:
  const ScaledProgram::Point& At(Index n, const Number* x) {
    u_ = Eigen::Map<const VectorXd>(x, n);
    return program_.At(u_);
  }

  ScaledProgram& program_;
  const ProgramOptions& options_;
  VectorXd u_;
};

std::string InWords(Ipopt::ApplicationReturnStatus status) {
  switch (status) {
    case Ipopt::Solve_Succeeded:
    case Ipopt::Solved_To_Acceptable_Level:
      return "Ipopt: solved";
    case Ipopt::Infeasible_Problem_Detected:
      return "Ipopt: no point near by keeps the constraints";
    case Ipopt::User_Requested_Stop:
    case Ipopt::Maximum_Iterations_Exceeded:
      return "Ipopt: evaluations are spent";
    case Ipopt::Invalid_Number_Detected:
      return "Ipopt: not defined at its start";
    default:
      return "Ipopt: stopped with code " + std::to_string(static_cast<int>(status));
  }
}

/// Never deleted, as Ipopt's own libraries may be gone by then.
Ipopt::IpoptApplication& KeptForPrograms() {
  static auto* const kept =
      new Ipopt::SmartPtr<Ipopt::IpoptApplication>(new Ipopt::IpoptApplication(false));
  return **kept;
}

std::string MinimiseByIpopt(ScaledProgram& program, const ProgramOptions& options,
                            const VectorXd& u) {
  const std::lock_guard lock(IpoptMutex());
  Ipopt::IpoptApplication& application = KeptForPrograms();
  const auto& list = application.Options();
  list->SetIntegerValue("print_level", 0);
  list->SetStringValue("sb", "yes");
  list->SetStringValue("linear_solver", "mumps");
  list->SetStringValue("hessian_approximation", "limited-memory");
  list->SetStringValue("mu_strategy", "adaptive");
  list->SetNumericValue("bound_relax_factor", 0);
  list->SetNumericValue("tol", std::max(1e-9, options.tolerance));
  list->SetNumericValue("constr_viol_tol", 0.1 * program.feasibility());
  list->SetIntegerValue("max_iter", options.max_evaluations);
  application.Initialize("");
  const Ipopt::SmartPtr<Ipopt::TNLP> nlp = new ProgramNlp(program, options, u);
  return InWords(application.OptimizeTNLP(nlp));
}

}  // namespace
}  // namespace vmech

extern "C" const vmech::MinimiseFunction vmech_minimise;
const vmech::MinimiseFunction vmech_minimise = vmech::MinimiseByIpopt;
