#pragma once

#include <vector>

#include "vmech/solvers/constrained_least_squares.h"

namespace vmech {

/// How FindStarts() looks. Raising `samples` finds more basins and costs time in proportion.
struct StartsOptions {
  int samples = 200;  ///< points looked at, in [1, 1e7]
  int kept = 10;      ///< starts returned at most, in [1, 1e6]
  /// Half the width of the search about x0 in tangents without bounds, in [1e-6, 1e6]; half a turn
  /// for angles.
  double radius = 3.141592653589793;
  /// lambda of the penalty function that ranks the points [-], in [1e-3, 1e6]; low, so that valleys
  /// of c are wide.
  double weight = 10;
  int steps = 15;  ///< of descent from each point before it is ranked, in [0, 1e4]
  /// Starts that differ by less in every coordinate count as one, in [1e-300, 1e300].
  double separation = 0.05;

  /// Throws std::invalid_argument with the name, the value and the range of what is wrong.
  void Validate() const;
};

/// The k-th point of a sequence that fills the unit cube [0, 1)^n evenly, however many of it are
/// taken: multiples of the powers of 1/g, g^(n+1) = g + 1 [Roberts 2018].
VectorXd EvenPoint(int n, int k);

/// Starts for any back end, the best first: points that fill the bounds evenly (x0 the first of
/// them), brought down 1/2 |r|^2 + lambda^2/2 |c|^2 by a few steps, without those that meet. At
/// least one. The same every time: the points are those of EvenPoint.
///
/// The global methods of NLopt (DIRECT, CRS, ISRES, MLSL) return one point; who looks for every
/// assembly mode, or distrusts a start, needs one in each basin, at the price of MLSL's first
/// round.
std::vector<VectorXd> FindStarts(ConstrainedLeastSquares& problem, const VectorXd& x0,
                                 const StartsOptions& options = {});

}  // namespace vmech
