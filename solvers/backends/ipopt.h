#pragma once

#include "vmech/solvers/constrained_least_squares.h"
#include "vmech/solvers/stopping_rule.h"
#include "vmech/solvers/summary.h"

namespace vmech {

/// The interior-point method of Ipopt with exact constraints, exact Jacobian and, where the problem
/// has second derivatives, the exact Hessian of the Lagrangian (else Gauss-Newton's). Redundant
/// rows are taken out first (tangent_chart.h). Linear solver: MUMPS. No file is read, nothing is
/// printed. Ipopt is not thread-safe: solves wait for each other within the process.
/// [Waechter & Biegler 2006]
struct IpoptOptions {
  /// Ipopt's own tolerance on its scaled optimality error, in [1e-14, 1e-2]; the stopping rule
  /// decides whether it was enough.
  double tolerance = 1e-11;
  /// The barrier to begin with, in [1e-12, 1e3]. Lower it for starts near the solution.
  double initial_barrier = 1e-3;
  StoppingRule stopping;  ///< the verdict on where it ended

  void Validate() const;  ///< @throws std::invalid_argument naming field, value and range
};

/// Solves by Ipopt from x0; where it ended is judged by `options.stopping`.
/// @throws std::invalid_argument as Validate.
Summary Solve(ConstrainedLeastSquares& problem, const IpoptOptions& options, const VectorXd& x0);

}  // namespace vmech
