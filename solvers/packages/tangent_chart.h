#pragma once

#include <functional>

#include "vmech/solvers/optimality.h"
#include "vmech/solvers/run.h"

namespace vmech {

/// A problem about a base point as plain vectors, for packages that know nothing else:
/// y -> Plus(base, y), y = 0 to begin with. The constraints are V'c(y) = 0, V an orthonormal basis
/// of the range of C at closed poses near by, so that redundant rows are gone. A rank that drops
/// at the base alone (a dead centre) takes no constraint away.
class TangentChart {
 public:
  TangentChart(CountedProblem& problem, const VectorXd& base);

  int num_variables() const { return static_cast<int>(lower.size()); }
  int num_constraints() const { return static_cast<int>(V_.cols()); }
  VectorXd Point(const VectorXd& y) const;

  /// Linearises at y unless it already is; derivatives are with respect to y.
  const Linearization& At(const VectorXd& y);
  VectorXd Gradient() const { return at_y_.J.transpose() * at_y_.r; }

  /// sigma (J'J + sum r_i d2r_i) + sum mu_j d2(V'c)_j at the y of the last At(), sigma > 0;
  /// without second derivatives sigma J'J. Exact at y = 0, and everywhere if x is a plain vector.
  MatrixXd Hessian(double sigma, const VectorXd& mu);

  VectorXd lower, upper;  ///< of y; on a manifold no chart reaches further than 2 [rad]

 private:
  MatrixXd PlusDerivative(const VectorXd& y) const;

  CountedProblem& problem_;
  VectorXd base_, y_, x_;
  MatrixXd V_, T_;
  Linearization at_x_, at_y_;
};

/// Runs `solve` in one chart after another, each based where the last ended, until the stopping
/// rule is met, the point no longer moves or the iterations are spent.
/// solve(chart, iterations left, &y) starts at y = 0.
using ChartSolve = std::function<Outcome(TangentChart& chart, int max_iterations, VectorXd* y)>;
Outcome SolveInCharts(CountedProblem& problem, const StoppingRule& rule, VectorXd* x,
                      const ChartSolve& solve);

}  // namespace vmech
