#include "vmech/solvers/packages/ceres_rows.h"

#include <algorithm>

namespace vmech {
namespace {

NullMotions::Held NoneHeld(const ConstrainedLeastSquares& problem) {
  return NullMotions::Held::Constant(problem.sizes().tangents, false);
}

using Rows = Eigen::Map<Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>>;

}  // namespace

FreeTangents::FreeTangents(const ConstrainedLeastSquares& problem, const std::vector<bool>& held)
    : problem_(problem), step_(VectorXd::Zero(problem.sizes().tangents)) {
  for (int i = 0; i < problem.sizes().tangents; ++i) {
    if (!held[i]) free_.push_back(i);
  }
}

bool FreeTangents::Plus(const double* x, const double* delta, double* x_plus_delta) const {
  VectorXd moved = Eigen::Map<const VectorXd>(x, AmbientSize());
  step_(free_) = Eigen::Map<const VectorXd>(delta, TangentSize());
  problem_.Plus(moved, step_, &moved);
  std::copy(moved.begin(), moved.end(), x_plus_delta);
  return true;
}

bool FreeTangents::PlusJacobian(const double*, double* jacobian) const {
  Rows selection(jacobian, AmbientSize(), TangentSize());
  selection.setZero();
  for (int k = 0; k < TangentSize(); ++k) selection(free_[k], k) = 1;
  return true;
}

WeightedRows::WeightedRows(ConstrainedLeastSquares& problem, double weight, const VectorXd& mu,
                           int null_motions)
    : problem_(problem),
      weight_(weight),
      mu_(mu),
      null_motions_(null_motions),
      at_x_(problem.sizes()),
      null_(problem.sizes().tangents) {
  set_num_residuals(problem.sizes().residuals + problem.sizes().constraints + null_motions);
  mutable_parameter_block_sizes()->push_back(problem.sizes().coordinates);
}

bool WeightedRows::Evaluate(double const* const* parameters, double* residuals,
                            double** jacobians) const {
  const ProblemSizes& sizes = problem_.sizes();
  const VectorXd x = Eigen::Map<const VectorXd>(parameters[0], sizes.coordinates);
  const bool derivatives = jacobians && jacobians[0];
  problem_.Evaluate(x, &at_x_.r, derivatives ? &at_x_.J : nullptr, &at_x_.c,
                    derivatives ? &at_x_.C : nullptr);
  Eigen::Map<VectorXd> rows(residuals, num_residuals());
  rows << at_x_.r, weight_ * at_x_.c + mu_ / weight_, VectorXd::Zero(null_motions_);
  if (derivatives) {
    Rows D(jacobians[0], num_residuals(), sizes.coordinates);
    D.setZero();
    D.topLeftCorner(sizes.residuals, sizes.tangents) = at_x_.J;
    D.block(sizes.residuals, 0, sizes.constraints, sizes.tangents) = weight_ * at_x_.C;
    if (null_motions_ > 0) null_.Find(at_x_, NoneHeld(problem_));
    for (int k = 0; k < std::min(null_motions_, null_.count()); ++k) {
      D.row(sizes.residuals + sizes.constraints + k).head(sizes.tangents) = null_.motion(k);
    }
  }
  return rows.allFinite();
}

OptimalityRows::OptimalityRows(ConstrainedLeastSquares& problem, const std::vector<bool>& held)
    : problem_(problem), held_(held), at_x_(problem.sizes()), null_(problem.sizes().tangents) {
  const ProblemSizes& sizes = problem.sizes();
  set_num_residuals(sizes.tangents + sizes.constraints);
  mutable_parameter_block_sizes()->push_back(sizes.coordinates);
  if (sizes.constraints > 0) mutable_parameter_block_sizes()->push_back(sizes.constraints);
}

bool OptimalityRows::Evaluate(double const* const* parameters, double* residuals,
                              double** jacobians) const {
  const int n = problem_.sizes().tangents, m = problem_.sizes().constraints;
  const VectorXd x = Eigen::Map<const VectorXd>(parameters[0], problem_.sizes().coordinates);
  const VectorXd mu = Eigen::Map<const VectorXd>(m > 0 ? parameters[1] : nullptr, m);
  at_x_.Evaluate(problem_, x);
  Rows rows(residuals, num_residuals(), 1);
  rows << at_x_.J.transpose() * at_x_.r + at_x_.C.transpose() * mu, at_x_.c;
  // [H C'; C 0]
  Rows by_x(nullptr, 0, 0), by_mu(nullptr, 0, 0);
  if (jacobians && jacobians[0]) {
    new (&by_x) Rows(jacobians[0], num_residuals(), x.size());
    by_x.setZero();
    by_x.topLeftCorner(n, n) = Hessian(x, mu);
    by_x.bottomLeftCorner(m, n) = at_x_.C;
  }
  if (m > 0 && jacobians && jacobians[1]) {
    new (&by_mu) Rows(jacobians[1], num_residuals(), m);
    by_mu << at_x_.C.transpose(), MatrixXd::Zero(m, m);
  }
  for (int i = 0; i < n; ++i) {
    if (!held_[i]) continue;
    rows.row(i).setZero();
    if (by_x.size() > 0) by_x.row(i).setZero();
    if (by_mu.size() > 0) by_mu.row(i).setZero();
  }
  return rows.allFinite();
}

// J'J, with the second derivatives if the problem has them, and stiff along null motions.
MatrixXd OptimalityRows::Hessian(const VectorXd& x, const VectorXd& mu) const {
  MatrixXd S = MatrixXd::Zero(at_x_.J.cols(), at_x_.J.cols());
  if (problem_.has_second_derivatives()) problem_.Curvature(x, mu, &S);
  S += at_x_.J.transpose() * at_x_.J;
  null_.Find(at_x_, NoneHeld(problem_));
  null_.Stiffen(1, &S);
  return S;
}

}  // namespace vmech
