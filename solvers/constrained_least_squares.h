#pragma once

#include <limits>
#include <vector>

#include "vmech/base/eigen.h"

namespace vmech {

using Eigen::MatrixXd;
using Eigen::VectorXd;

/// lower <= x[coordinate] <= upper, for a coordinate that a step changes by plain addition:
/// Plus(x, dx)[coordinate] = x[coordinate] + dx[tangent].
struct Bound {
  int coordinate = 0;                                       ///< index in x
  int tangent = 0;                                          ///< index in dx
  double lower = -std::numeric_limits<double>::infinity();  ///< in the coordinate's unit
  double upper = std::numeric_limits<double>::infinity();   ///< in the coordinate's unit
};

/// How many numbers the parts of a problem have.
struct ProblemSizes {
  int coordinates = 0;  ///< of x
  int tangents = 0;     ///< of a step dx; smaller than `coordinates` where x holds quaternions
  int residuals = 0;    ///< of r
  int constraints = 0;  ///< of c
};

/// The problem that every back end solves:
///
///     minimise 1/2 |r(x)|^2   subject to   c(x) = 0,   lower <= x <= upper
///
/// x may live on a manifold: a solver moves it by Plus(x, dx) alone, and every derivative is taken
/// with respect to dx at dx = 0. Rows of c may be redundant. One object serves one thread at a
/// time (it may own a workspace); objects of their own may be solved in parallel.
class ConstrainedLeastSquares {
 public:
  /// Throws std::invalid_argument where sizes are negative, a bound names no coordinate or is
  /// empty.
  explicit ConstrainedLeastSquares(const ProblemSizes& sizes, std::vector<Bound> bounds = {});
  virtual ~ConstrainedLeastSquares() = default;

  const ProblemSizes& sizes() const { return sizes_; }          ///< of r, x, dx and c
  const std::vector<Bound>& bounds() const { return bounds_; }  ///< empty: x is free

  /// Writes r, J = dr/dx, c and C = dc/dx at x into memory of the right size; a null pointer
  /// means "not wanted". Must not throw; where the problem is not defined it writes NaN. The
  /// allocation-free back ends allocate nothing if this function and Plus do not.
  virtual void Evaluate(const VectorXd& x, VectorXd* r, MatrixXd* J, VectorXd* c, MatrixXd* C) = 0;

  /// x_plus = x (+) dx, with Plus(x, 0) = x; x_plus may be x itself. Plain addition by default.
  virtual void Plus(const VectorXd& x, const VectorXd& dx, VectorXd* x_plus) const;

  /// Whether Curvature() is there. Without it solvers use the Gauss-Newton approximation.
  virtual bool has_second_derivatives() const { return false; }

  /// S = sum_i r_i d2r_i/dx2 + sum_j mu_j d2c_j/dx2 at x: what J'J lacks of the Hessian of
  /// 1/2 |r|^2 + mu' c, both derivatives taken of f(Plus(x, dx)) at dx = 0.
  virtual void Curvature(const VectorXd& x, const VectorXd& mu, MatrixXd* S);

 private:
  ProblemSizes sizes_;
  std::vector<Bound> bounds_;
};

}  // namespace vmech
