#include "vmech/solvers/held_coordinates.h"

#include "vmech/base/check_range.h"

namespace vmech {

HeldCoordinates::HeldCoordinates(ConstrainedLeastSquares& problem, std::vector<int> held)
    : ConstrainedLeastSquares(problem.sizes(), problem.bounds()),
      problem_(problem),
      held_(std::move(held)) {
  for (int tangent : held_) {
    CheckRange("HeldCoordinates", "held", tangent, 0, problem.sizes().tangents - 1);
  }
}

void HeldCoordinates::Evaluate(const VectorXd& x, VectorXd* r, MatrixXd* J, VectorXd* c,
                               MatrixXd* C) {
  problem_.Evaluate(x, r, J, c, C);
  for (int tangent : held_) {
    if (J) J->col(tangent).setZero();
    if (C) C->col(tangent).setZero();
  }
}

void HeldCoordinates::Curvature(const VectorXd& x, const VectorXd& mu, MatrixXd* S) {
  problem_.Curvature(x, mu, S);
  for (int tangent : held_) {
    S->col(tangent).setZero();
    S->row(tangent).setZero();
  }
}

}  // namespace vmech
