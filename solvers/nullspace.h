#pragma once

#include <memory>

#include "vmech/solvers/constrained_least_squares.h"
#include "vmech/solvers/fast_outcome.h"
#include "vmech/solvers/stopping_rule.h"
#include "vmech/solvers/summary.h"

namespace vmech {

/// Exact equality-constrained Gauss-Newton by the null space of C: with C = V L Y' (see
/// CompleteOrthogonal) and B = J'J, or the exact Hessian of the Lagrangian where the problem has
/// second derivatives and Z'BZ is positive definite,
///
///     d = v + Z w,    v = -C^+ c,    Z'B Z w = -Z'(J'r + B v)
///
/// Redundant rows need no care: rank decides. Bounds enter through a working set. A line search on
/// 1/2 |r|^2 + nu |c|_2 with second-order correction makes it safe from far starts.
/// [Nocedal & Wright 2006, 18.3 and 18.5]
struct NullspaceOptions {
  /// Pivots of C below this, relative to the largest, count as zero, in [1e-14, 1e-2]. Raise it
  /// for noisy Jacobians; lower it near dead centres.
  double rank_tolerance = 1e-9;
  /// Longest step, max |dx_i| [unit of the tangent], >= 1e-12. Lower it to stay on one branch.
  double max_step = std::numeric_limits<double>::infinity();
  /// Use the problem's second derivatives if it has them: quadratic convergence.
  bool use_second_derivatives = true;
  StoppingRule stopping;  ///< when it counts as solved

  void Validate() const;  ///< @throws std::invalid_argument naming field, value and range
};

/// What a solve works with; for problems of the sizes of one. A first solve, and the first that
/// meets bounds, may take more memory.
class NullspaceWorkspace {
 public:
  explicit NullspaceWorkspace(const ConstrainedLeastSquares& problem);  ///< of its sizes
  /// The other can only be destroyed or assigned.
  NullspaceWorkspace(NullspaceWorkspace&&) noexcept;
  /// The other can only be destroyed or assigned.
  NullspaceWorkspace& operator=(NullspaceWorkspace&&) noexcept;
  ~NullspaceWorkspace();

 private:
  friend FastOutcome Solve(ConstrainedLeastSquares&, const NullspaceOptions&, VectorXd*,
                           NullspaceWorkspace*) noexcept;
  class Solver;
  std::unique_ptr<Solver> solver_;
};

/// From *x to a constrained minimum; no allocation with a workspace that has solved before.
[[nodiscard]] FastOutcome Solve(ConstrainedLeastSquares& problem, const NullspaceOptions& options,
                                VectorXd* x, NullspaceWorkspace* workspace) noexcept;

/// The same from x0, with the outcome judged.
Summary Solve(ConstrainedLeastSquares& problem, const NullspaceOptions& options,
              const VectorXd& x0);

}  // namespace vmech
