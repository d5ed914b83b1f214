#pragma once

#include <vector>

#include "vmech/solvers/constrained_least_squares.h"
#include "vmech/solvers/stopping_rule.h"
#include "vmech/solvers/summary.h"

namespace vmech {

/// KINSOL of SUNDIALS, Newton with line search on a square system. With coordinates held (a driving
/// joint) and as many free ones as constraints are independent, that is c(x) = 0 alone; else it is
///
///     J'r + C'mu = 0,   c = 0
///
/// in the free coordinates and mu. Equations know no bounds: where one is violated at the end the
/// status is kUnsuitable.
/// [Hindmarsh et al. 2005]
struct KinsolOptions {
  /// Tangents that keep the value of the start; the verdict is on the others.
  std::vector<int> held;
  /// Largest residual of the system that ends the iteration, in [1e-16, 1e-3].
  double tolerance = 1e-13;
  StoppingRule stopping;  ///< the verdict on where it ended

  void Validate() const;  ///< @throws std::invalid_argument naming field, value and range
};

/// Solves by KINSOL from x0; where it ended is judged by `options.stopping`.
/// @throws std::invalid_argument as Validate.
Summary Solve(ConstrainedLeastSquares& problem, const KinsolOptions& options, const VectorXd& x0);

}  // namespace vmech
