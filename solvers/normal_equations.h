#pragma once

#include "vmech/solvers/optimality.h"

namespace vmech {

/// The normal equations of a Gauss-Newton step on 1/2 |r|^2 + mu' c + w/2 |c|^2, and their factors:
///
///     H dx = -g,   H = J'J + w C'C,   g = J'r + C'(mu + w c),   H + damping = L D L'
///
/// with unknowns that may be held where they are. Made for some ten unknowns, where calls cost more
/// than the arithmetic behind them. All memory is taken by the constructor.
class NormalEquations {
 public:
  explicit NormalEquations(int unknowns);  ///< n, the size of g

  int size() const noexcept { return static_cast<int>(g.size()); }  ///< unknowns

  /// H and g at a point; forces = mu + w c there.
  void Form(const Linearization& at_x, double weight, const VectorXd& forces) noexcept;

  /// Factors H + diag(damping), rows and columns that are held left out. False if that is not
  /// positive definite.
  [[nodiscard]] bool Factor(const VectorXd& damping) noexcept;

  /// x = (H + diag(damping))^-1 x, zero where held.
  void Solve(VectorXd* x) const noexcept;

  MatrixXd H;                                   ///< lower triangle
  VectorXd g;                                   ///< J'r + C' forces [n]
  VectorXd objective_gradient;                  ///< J'r, the first part of g
  Eigen::Matrix<bool, Eigen::Dynamic, 1> held;  ///< [n] those that Solve leaves where they are

 private:
  struct Kernels;
  void Isolate(int j) noexcept;

  const Kernels* kernels_;
  MatrixXd factor_;  // unit L below the diagonal, 1/D on it
};

}  // namespace vmech
