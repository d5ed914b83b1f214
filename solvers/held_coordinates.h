#pragma once

#include <vector>

#include "vmech/solvers/constrained_least_squares.h"

namespace vmech {

/// A problem some of whose tangents are held where they are: nothing depends on them, that is,
/// their columns of J, C and S are zero. A minimum is then one in the others.
class HeldCoordinates final : public ConstrainedLeastSquares {
 public:
  /// Throws std::invalid_argument where `held` names a tangent that the problem does not have.
  HeldCoordinates(ConstrainedLeastSquares& problem, std::vector<int> held);

  void Evaluate(const VectorXd& x, VectorXd* r, MatrixXd* J, VectorXd* c, MatrixXd* C) override;
  void Plus(const VectorXd& x, const VectorXd& dx, VectorXd* x_plus) const override {
    problem_.Plus(x, dx, x_plus);
  }
  bool has_second_derivatives() const override { return problem_.has_second_derivatives(); }
  void Curvature(const VectorXd& x, const VectorXd& mu, MatrixXd* S) override;

 private:
  ConstrainedLeastSquares& problem_;
  std::vector<int> held_;
};

}  // namespace vmech
