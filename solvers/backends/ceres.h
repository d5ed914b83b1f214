#pragma once

#include "vmech/solvers/constrained_least_squares.h"
#include "vmech/solvers/stopping_rule.h"
#include "vmech/solvers/summary.h"

namespace vmech {

/// How Ceres, which knows no constraints, is made to keep them.
enum class CeresMethod {
  kWeighted,  ///< constraints as residuals of one weight: biased, as `penalty` is
  kExact,     ///< the same with multiplier updates until the stopping rule is met
};

/// Levenberg-Marquardt of Ceres Solver, by QR, on
///
///     1/2 |r|^2 + 1/2 |w (c + mu/w^2)|^2,      mu += w^2 c after each solve (kExact)
///
/// Ceres projects its steps on the bounds, which leaves it stuck where a bound is active and the
/// constraints are stiff: the projected step leaves the constraints, and only steps of no length
/// are then accepted. So coordinates that have arrived at a bound are taken out of the manifold
/// that Ceres moves on, and let go again where their bound would have to pull: an active set.
/// [Agarwal, Mierle et al., Ceres Solver 2.1; Nocedal & Wright 2006, 17.3 and 16.5]
struct CeresOptions {
  CeresMethod method = CeresMethod::kExact;  ///< exact, or weighted
  /// w of kWeighted [-], in [1, 1e6], see PenaltyOptions::weight. Reached from 10 by powers of ten,
  /// so that curved constraints are met while they are soft.
  double weight = 1e3;
  /// Largest w of kExact [-], in [10, 1e7], which begins with 10 and raises it where the
  /// constraints close too slowly.
  double max_weight = 1e5;
  StoppingRule stopping;  ///< the verdict on where it ended

  void Validate() const;  ///< @throws std::invalid_argument naming field, value and range
};

/// Solves by Ceres from x0; where it ended is judged by `options.stopping`.
/// @throws std::invalid_argument as Validate.
Summary Solve(ConstrainedLeastSquares& problem, const CeresOptions& options, const VectorXd& x0);

}  // namespace vmech
