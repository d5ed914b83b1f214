#pragma once

#include <vector>

#include "vmech/base/linear_algebra/complete_orthogonal.h"
#include "vmech/solvers/constrained_least_squares.h"

namespace vmech {

/// r, c and their Jacobians at one point.
struct Linearization {
  VectorXd r, c;  ///< objective's rows, constraints' rows
  MatrixXd J, C;  ///< by the tangent, [rows, tangents]

  explicit Linearization(const ProblemSizes& sizes);                   ///< sized, not evaluated
  void Evaluate(ConstrainedLeastSquares& problem, const VectorXd& x);  ///< at x
  bool AllFinite() const;                    ///< no NaN in it, and nothing infinite
  void Swap(Linearization* other) noexcept;  ///< exchanges memory, copies nothing
};

/// How near a point is to a constrained minimum; see Summary for the sign of the multipliers.
struct Optimality {
  double objective = 0;        ///< 1/2 |r|^2
  double constraint_norm = 0;  ///< max |c_i|
  double bound_violation = 0;  ///< max of lower - x, x - upper and 0
  /// max of |J'r + C'mu + z| and of the complementarity |z_i| (distance to the bound), over
  /// max(1, max |J'r|). mu and z minimise |J'r + C'mu + z| under the signs that z must have, so
  /// no multiplier of a back end enters.
  double kkt_error = 0;
  /// |C'c| over |c| max(|C|, |c|), bounds allowed for: near 0 where |c| is stationary but not zero.
  double infeasibility_slope = 1;
  VectorXd multipliers;        ///< mu, one per row of c
  VectorXd bound_multipliers;  ///< z, one per bound of the problem
};

/// Measures optimality. Takes memory only where a problem is larger than all before.
class OptimalityMeter {
 public:
  /// rank_tolerance: relative pivot below which rows of C count as redundant. What is returned
  /// lives until the next call.
  const Optimality& Measure(const std::vector<Bound>& bounds, const VectorXd& x,
                            const Linearization& at_x, double rank_tolerance = 1e-9);

  /// Of the C measured last, factored to rank_tolerance; the rank is that of the measurement, which
  /// takes no pivot below |c| / |C| for one.
  CompleteOrthogonal& factors() { return factors_; }

 private:
  /// A bound that x is near to, and the force that it carries.
  struct NearBound {
    int index;  // in the problem's list
    int tangent;
    double sign;      // +1 at the upper bound, -1 at the lower
    double distance;  // to the bound
    bool used;        // may carry a force
    double force;     // y >= 0
  };

  void FindNearBounds(const std::vector<Bound>& bounds, const VectorXd& x);
  void FindMultipliers(const Linearization& at_x, double rank_tolerance);
  bool UseSteepest();
  void SolveWithUsed(const MatrixXd& C, double rank_tolerance);
  NearBound* WorstPulling();
  double InfeasibilitySlope(const Linearization& at_x);

  Optimality result_;
  std::vector<NearBound> near_;
  VectorXd gradient_, residual_;
  std::vector<double> negative_, solution_;  // -J'r; mu and the forces of the bounds in use
  CompleteOrthogonal factors_, factors_with_bounds_;
};

/// The same for a single use, without a meter to keep.
Optimality MeasureOptimality(const std::vector<Bound>& bounds, const VectorXd& x,
                             const Linearization& at_x, double rank_tolerance = 1e-9);

/// Whether the Hessian of the Lagrangian, J'J + S, nowhere curves downwards along the constraints
/// and the bounds that x lies on: it does at saddle points and maxima, where the KKT error vanishes
/// too. True for problems without second derivatives, of which nothing is known.
bool CurvesUpwards(ConstrainedLeastSquares& problem, const VectorXd& x, const Linearization& at_x,
                   const VectorXd& multipliers);

}  // namespace vmech
