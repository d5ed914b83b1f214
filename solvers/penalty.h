#pragma once

#include "vmech/solvers/fast_outcome.h"
#include "vmech/solvers/stopping_rule.h"
#include "vmech/solvers/summary.h"
#include "vmech/solvers/weighted_step.h"

namespace vmech {

/// The penalty method of the paper, eq. (8): the constraints become residuals of weight lambda,
///
///     [ J; lambda C ] dx = - [ r; lambda c ]
///
/// iterated. It is biased: at its fixed point J'r + lambda^2 C'c = 0, so the constraints stay open
/// by multiplier / lambda^2. The bound on |c| is reported.
struct PenaltyOptions {
  /// lambda [-], in [1, 1e6]. Raising it closes the constraints better and leaves less precision
  /// for the free motion.
  double weight = 1e3;
  /// Least Marquardt damping, relative to the diagonal of H, in [1e-14, 1]. Raise it where H is
  /// nearly singular and steps wander.
  double damping = 1e-12;
  /// Longest step, max |dx_i| [unit of the tangent], >= 1e-12. Lower it to stay on one branch.
  double max_step = std::numeric_limits<double>::infinity();
  StoppingRule stopping;  ///< when it counts as solved

  void Validate() const;  ///< @throws std::invalid_argument naming field, value and range
};

/// Memory of the penalty method, made once for a problem.
struct PenaltyWorkspace {
  explicit PenaltyWorkspace(const ConstrainedLeastSquares& problem);  ///< of its sizes
  WeightedStep step;                                                  ///< of paper eq. (8)
  VectorXd no_multipliers;                                            ///< stays zero
};

/// One step of paper eq. (8) from *x, undivided: bounded work, no allocation.
[[nodiscard]] StepReport Step(ConstrainedLeastSquares& problem, const PenaltyOptions& options,
                              VectorXd* x, PenaltyWorkspace* workspace) noexcept;

/// Steps with damping until the penalty function is stationary; no allocation.
[[nodiscard]] FastOutcome Solve(ConstrainedLeastSquares& problem, const PenaltyOptions& options,
                                VectorXd* x, PenaltyWorkspace* workspace) noexcept;

/// The same from x0, with the outcome judged. The status is kBiased unless the bias is within the
/// stopping rule.
Summary Solve(ConstrainedLeastSquares& problem, const PenaltyOptions& options, const VectorXd& x0);

}  // namespace vmech
