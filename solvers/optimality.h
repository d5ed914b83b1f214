#pragma once

#include "vmech/solvers/constrained_least_squares.h"

namespace vmech {

/// r, c and their Jacobians at one point.
struct Linearization {
  VectorXd r, c;
  MatrixXd J, C;

  explicit Linearization(const ProblemSizes& sizes);
  void Evaluate(ConstrainedLeastSquares& problem, const VectorXd& x);
  bool AllFinite() const;
  void Swap(Linearization* other) noexcept;  ///< exchanges memory, copies nothing
};

/// How near a point is to a constrained minimum; see Summary for the sign of the multipliers.
struct Optimality {
  double objective = 0;        ///< 1/2 |r|^2
  double constraint_norm = 0;  ///< max |c_i|
  double bound_violation = 0;
  /// max of |J'r + C'mu + z| and of the complementarity |z_i| (distance to the bound), over
  /// max(1, max |J'r|). mu and z minimise |J'r + C'mu + z| under the signs that z must have, so
  /// no multiplier of a back end enters.
  double kkt_error = 0;
  /// |C'c| over |c| max(|C|, |c|), bounds allowed for: near 0 where |c| is stationary but not zero.
  double infeasibility_slope = 1;
  VectorXd multipliers;
  VectorXd bound_multipliers;
};

/// rank_tolerance: relative pivot below which rows of C count as redundant.
Optimality MeasureOptimality(const std::vector<Bound>& bounds, const VectorXd& x,
                             const Linearization& at_x, double rank_tolerance = 1e-9);

/// Whether the Hessian of the Lagrangian, J'J + S, nowhere curves downwards along the constraints
/// and the bounds that x lies on: it does at saddle points and maxima, where the KKT error vanishes
/// too. True for problems without second derivatives, of which nothing is known.
bool CurvesUpwards(ConstrainedLeastSquares& problem, const VectorXd& x, const Linearization& at_x,
                   const VectorXd& multipliers);

}  // namespace vmech
