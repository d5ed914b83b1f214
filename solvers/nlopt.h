#pragma once

#include "vmech/solvers/constrained_least_squares.h"
#include "vmech/solvers/stopping_rule.h"
#include "vmech/solvers/summary.h"

namespace vmech {

/// SLSQP, sequential quadratic programming, of NLopt. Redundant rows are taken out first
/// (tangent_chart.h). It closes the constraints and stops where the objective no longer changes,
/// which leaves a KKT error near 1e-8: under a tighter rule the status is kStalled.
/// [Kraft 1994; Johnson, The NLopt nonlinear-optimization package, 2.7]
struct NloptOptions {
  /// Steps and changes of the objective that end a run, relative, in [1e-17, 1e-3].
  double tolerance = 1e-15;
  StoppingRule stopping;

  void Validate() const;
};

Summary Solve(ConstrainedLeastSquares& problem, const NloptOptions& options, const VectorXd& x0);

}  // namespace vmech
