#pragma once

#include <ceres/cost_function.h>
#include <ceres/manifold.h>

#include <vector>

#include "vmech/solvers/null_motions.h"

namespace vmech {

// What ceres.cc hands to Ceres. Ceres multiplies a Jacobian by that of Plus; with [D 0] for the
// one and a selection of columns for the other it gets the columns of D, the derivative by the
// step, which is what a problem offers.

/// A problem's coordinates, moved along those of its tangents that are not held.
class FreeTangents final : public ceres::Manifold {
 public:
  FreeTangents(const ConstrainedLeastSquares& problem, const std::vector<bool>& held);

  int AmbientSize() const override { return problem_.sizes().coordinates; }
  int TangentSize() const override { return static_cast<int>(free_.size()); }
  bool Plus(const double* x, const double* delta, double* x_plus_delta) const override;
  bool PlusJacobian(const double* x, double* jacobian) const override;
  // The trust-region minimiser never asks how two points differ.
  bool Minus(const double*, const double*, double*) const override { return false; }
  bool MinusJacobian(const double*, double*) const override { return false; }

 private:
  const ConstrainedLeastSquares& problem_;
  std::vector<int> free_;
  mutable VectorXd step_;  // zero where held; Ceres calls from one thread
};

/// [r; w c + mu/w; 0] in x. The zeros have the null motions for their Jacobian: a step of theirs
/// would cost, so that there is none. There are `null_motions` of them at most.
class WeightedRows final : public ceres::CostFunction {
 public:
  WeightedRows(ConstrainedLeastSquares& problem, double weight, const VectorXd& mu,
               int null_motions);
  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override;

 private:
  ConstrainedLeastSquares& problem_;
  double weight_;
  const VectorXd& mu_;
  int null_motions_;
  mutable Linearization at_x_;
  mutable NullMotions null_;
};

/// The conditions of a minimum, [J'r + C'mu; c], in x and mu; rows of held tangents are zero. Null
/// motions are stiff in their Jacobian, where the conditions leave them open.
class OptimalityRows final : public ceres::CostFunction {
 public:
  OptimalityRows(ConstrainedLeastSquares& problem, const std::vector<bool>& held);
  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override;

 private:
  MatrixXd Hessian(const VectorXd& x, const VectorXd& mu) const;

  ConstrainedLeastSquares& problem_;
  const std::vector<bool>& held_;
  mutable Linearization at_x_;
  mutable NullMotions null_;
};

}  // namespace vmech
