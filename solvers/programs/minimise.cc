#include "vmech/solvers/programs/minimise.h"

#include <fmt/format.h>

#include <cmath>
#include <stdexcept>
#include <vector>

#include "vmech/base/late_library.h"
#include "vmech/base/linear_algebra/linear_algebra.h"
#include "vmech/solvers/programs/scaled_program.h"

namespace vmech {
namespace {

constexpr double kActive = 1e-6;  // of a constraint, and of a variable from 0 to 1

MinimiseFunction FunctionOf(const LateLibrary& library, const char* debian) {
  if (library.loaded()) return library.Variable<MinimiseFunction>("vmech_minimise");
  throw std::runtime_error(fmt::format("{}; it is there if vmech is built where {} is installed",
                                       library.error(), debian));
}

MinimiseFunction FunctionOf(ProgramMethod method) {
  if (method == ProgramMethod::kIpopt) {
    static const LateLibrary ipopt("ipopt");
    return FunctionOf(ipopt, "coinor-libipopt-dev");
  }
  static const LateLibrary nlopt("nlopt");
  return FunctionOf(nlopt, "libnlopt-dev");
}

void RequireInside(const NonlinearProgram& program, const VectorXd& x0) {
  const VectorXd &lower = program.lower(), &upper = program.upper();
  const bool fits = x0.size() == lower.size() && upper.size() == lower.size() && x0.size() > 0;
  if (!fits || !(lower.array() < upper.array()).all() || !(x0.array() >= lower.array()).all() ||
      !(x0.array() <= upper.array()).all()) {
    throw std::invalid_argument("a program needs lower < upper and a start between them");
  }
}

/// Which constraints hold the best point, and by how much: df + dg' lambda + mu = 0 by least
/// squares over those that are active.
void FindMultipliers(const ScaledProgram::Point& point, const VectorXd& range,
                     ProgramResult* result) {
  const Eigen::Index n = point.u.size(), m = point.g.size();
  result->lambda = VectorXd::Zero(m);
  result->mu = VectorXd::Zero(n);
  std::vector<Eigen::Index> active;  // constraints, then m + variables
  for (Eigen::Index i = 0; i < m; ++i) {
    if (point.g[i] > -kActive) active.push_back(i);
  }
  for (Eigen::Index k = 0; k < n; ++k) {
    if (point.u[k] < kActive || point.u[k] > 1 - kActive) active.push_back(m + k);
  }
  MatrixXd A(n, static_cast<Eigen::Index>(active.size()));
  for (size_t c = 0; c < active.size(); ++c) {
    const auto column = static_cast<Eigen::Index>(c);
    A.col(column) = active[c] < m ? VectorXd(point.dg.row(active[c]).transpose())
                                  : VectorXd(VectorXd::Unit(n, active[c] - m));
  }
  VectorXd left = point.df;
  if (!active.empty()) {
    const VectorXd multipliers = MinimumNormSolution(A, -point.df);
    left += A * multipliers;
    for (size_t c = 0; c < active.size(); ++c) {
      const double value = multipliers[static_cast<Eigen::Index>(c)];
      if (active[c] < m) {
        result->lambda[active[c]] = value;
      } else {
        result->mu[active[c] - m] = value / range[active[c] - m];
      }
    }
  }
  result->optimality = point.f != 0 ? left.norm() / std::abs(point.f) : left.norm();
}

}  // namespace

ProgramResult Minimise(NonlinearProgram& program, const ProgramOptions& options,
                       const VectorXd& x0) {
  RequireInside(program, x0);
  ScaledProgram scaled(program, options.feasibility);
  const VectorXd u0 = (x0 - program.lower()).cwiseQuotient(scaled.Range());
  scaled.At(u0);
  ProgramResult result;
  result.message = FunctionOf(options.method)(scaled, options, u0);
  const ScaledProgram::Point& best = scaled.best();
  result.evaluations = scaled.evaluations();
  result.defined = best.defined;
  result.x = best.defined ? scaled.Unscaled(best.u) : x0;
  if (!best.defined) return result;
  result.f = best.f;
  result.g = best.g;
  result.feasible = scaled.IsFeasible(best);
  FindMultipliers(best, scaled.Range(), &result);
  return result;
}

}  // namespace vmech
