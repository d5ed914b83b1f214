#include "vmech/solvers/constrained_least_squares.h"

#include <fmt/format.h>

#include <stdexcept>

namespace vmech {
namespace {

void CheckBound(const Bound& bound, const ProblemSizes& sizes) {
  if (bound.coordinate < 0 || bound.coordinate >= sizes.coordinates || bound.tangent < 0 ||
      bound.tangent >= sizes.tangents) {
    throw std::invalid_argument(fmt::format(
        "a bound names coordinate {} and tangent {}, but the problem has {} and {} of them",
        bound.coordinate, bound.tangent, sizes.coordinates, sizes.tangents));
  }
  if (!(bound.lower <= bound.upper)) {
    throw std::invalid_argument(fmt::format("the bounds {} <= x[{}] <= {} leave no value",
                                            bound.lower, bound.coordinate, bound.upper));
  }
}

}  // namespace

ConstrainedLeastSquares::ConstrainedLeastSquares(const ProblemSizes& sizes,
                                                 std::vector<Bound> bounds)
    : sizes_(sizes), bounds_(std::move(bounds)) {
  if (sizes.tangents < 1 || sizes.coordinates < sizes.tangents || sizes.residuals < 0 ||
      sizes.constraints < 0) {
    throw std::invalid_argument(
        fmt::format("a problem cannot have {} coordinates, {} tangents, {} residuals and {} "
                    "constraints",
                    sizes.coordinates, sizes.tangents, sizes.residuals, sizes.constraints));
  }
  for (const Bound& bound : bounds_) CheckBound(bound, sizes_);
}

void ConstrainedLeastSquares::Plus(const VectorXd& x, const VectorXd& dx, VectorXd* x_plus) const {
  *x_plus = x + dx;
}

void ConstrainedLeastSquares::Curvature(const VectorXd&, const VectorXd&, MatrixXd*) {
  throw std::logic_error("this problem has no second derivatives: ask has_second_derivatives()");
}

}  // namespace vmech
