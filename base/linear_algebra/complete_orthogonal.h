#pragma once

#include <Eigen/Cholesky>

#include "vmech/base/eigen.h"

namespace vmech {

/// The complete orthogonal decomposition of an m x n matrix of rank p,
///
///     C = V L Y',   [Y Z] orthogonal (n x n),   V'V = 1 (m x p),   L upper triangular (p x p)
///
/// so that Y spans the row space and Z the null space of C, and V the range. It serves step,
/// multipliers and reduced constraints alike: C^+ b = Y L^-1 V' b and (C')^+ g = V L^-T Y' g.
/// [Golub & Van Loan, Matrix Computations, 5.4.7]
struct CompleteOrthogonal {
  Eigen::MatrixXd V, L, Y, Z;

  /// Pivots below rank_tolerance times the largest count as zero.
  CompleteOrthogonal(const Eigen::MatrixXd& C, double rank_tolerance);

  int rank() const { return static_cast<int>(L.rows()); }

  /// The shortest of the x that minimise |C x - b|^2 + damping |x|^2.
  Eigen::VectorXd Solve(const Eigen::VectorXd& b, double damping = 0) const;

  /// The shortest of the mu that minimise |C' mu - g|^2 + damping |mu|^2.
  Eigen::VectorXd SolveTransposed(const Eigen::VectorXd& g, double damping = 0) const;

 private:
  Eigen::LLT<Eigen::MatrixXd> Damped(double damping) const;  // factors of L'L + damping
};

}  // namespace vmech
