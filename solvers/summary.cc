#include "vmech/solvers/summary.h"

#include <fmt/format.h>

namespace vmech {
namespace {

std::string ListOf(std::string_view label, const Eigen::VectorXd& values) {
  std::string line = fmt::format("{:<22}", label);
  for (double value : values) line += fmt::format(" {:.9g}", value);
  return line + "\n";
}

}  // namespace

std::string_view NameOf(SolveStatus status) {
  constexpr std::string_view kNames[] = {"not run",    "converged",       "biased",
                                         "infeasible", "iteration limit", "stalled",
                                         "failed",     "unsuitable",      "unavailable"};
  return kNames[static_cast<int>(status)];
}

std::string Summary::BriefReport() const {
  return fmt::format("{}: {}, objective {:.6g}, |c| {:.2e}, KKT {:.2e}, {} iterations, {:.3g} ms",
                     solver, NameOf(status), objective, constraint_norm, kkt_error, iterations,
                     seconds * 1e3);
}

std::string Summary::FullReport() const {
  std::string page;
  page += fmt::format("{:<22} {}\n", "solver", solver);
  page += fmt::format("{:<22} {} ({})\n", "status", NameOf(status), message);
  page += fmt::format("{:<22} {:.12g}\n", "objective 1/2 |r|^2", objective);
  page += fmt::format("{:<22} {:.3e}\n", "constraints max |c|", constraint_norm);
  page += fmt::format("{:<22} {:.3e}\n", "bound violation", bound_violation);
  page += fmt::format("{:<22} {:.3e}\n", "KKT error, relative", kkt_error);
  if (bias_bound > 0) page += fmt::format("{:<22} {:.3e}\n", "bias: |c| at most", bias_bound);
  page += fmt::format("{:<22} {}\n", "iterations", iterations);
  page += fmt::format("{:<22} {}, with Jacobian {}\n", "evaluations", evaluations,
                      jacobian_evaluations);
  page += fmt::format("{:<22} {:.6f}\n", "time [s]", seconds);
  page += ListOf("x", x) + ListOf("multipliers", multipliers);
  if (bound_multipliers.size() > 0) page += ListOf("bound multipliers", bound_multipliers);
  return page;
}

}  // namespace vmech
