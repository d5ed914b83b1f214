#pragma once

#include "vmech/solvers/fast_outcome.h"
#include "vmech/solvers/stopping_rule.h"
#include "vmech/solvers/weighted_step.h"

namespace vmech {

/// The penalty method with its bias removed: the constraint error is shifted by the running
/// multiplier,
///
///     [ J; lambda C ] dx = - [ r; lambda (c + mu / lambda^2) ],      mu += lambda^2 (c + C dx)
///
/// so that lambda no longer decides how well the constraints close. [Hestenes 1969; Powell 1969]
struct AugmentedLagrangianOptions {
  /// lambda to begin with [-], in [1, 1e6]; `Step` keeps it, `Solve` raises it up to max_weight
  /// where the constraints close too slowly.
  double weight = 1e2;
  /// Largest lambda [-], in [weight, 1e7]. Above 1e4 rounding begins to win.
  double max_weight = 1e4;
  double damping = 1e-12;  ///< as PenaltyOptions::damping, in [1e-14, 1]
  double max_step = std::numeric_limits<double>::infinity();  ///< as PenaltyOptions::max_step
  /// `Solve` (not `Step`) uses the problem's second derivatives if it has them: it then converges
  /// where Gauss-Newton crawls, at the price of one Curvature() an iteration.
  bool use_second_derivatives = true;
  StoppingRule stopping;  ///< when it counts as solved

  void Validate() const;  ///< @throws std::invalid_argument naming field, value and range
};

/// Memory of the augmented Lagrangian, made once for a problem.
struct AugmentedLagrangianWorkspace {
  explicit AugmentedLagrangianWorkspace(const ConstrainedLeastSquares& problem);  ///< of its sizes
  WeightedStep step;     ///< of one descent
  VectorXd multipliers;  ///< the running mu: kept between calls, zero at first
};

/// One step and one multiplier update from *x: bounded work, no allocation.
[[nodiscard]] StepReport Step(ConstrainedLeastSquares& problem,
                              const AugmentedLagrangianOptions& options, VectorXd* x,
                              AugmentedLagrangianWorkspace* workspace) noexcept;

/// Minimisations and multiplier updates until the stopping rule is met; no allocation. Starts
/// from the workspace's multipliers.
[[nodiscard]] FastOutcome Solve(ConstrainedLeastSquares& problem,
                                const AugmentedLagrangianOptions& options, VectorXd* x,
                                AugmentedLagrangianWorkspace* workspace) noexcept;

/// The same from x0 and zero multipliers, with the outcome judged.
Summary Solve(ConstrainedLeastSquares& problem, const AugmentedLagrangianOptions& options,
              const VectorXd& x0);

}  // namespace vmech
