#pragma once

#include <vector>

#include "vmech/base/eigen.h"

namespace vmech {

/// The complete orthogonal decomposition of an m x n matrix of rank p,
///
///     C = V L Y',   [Y Z] orthogonal (n x n),   V'V = 1 (m x p),   L upper triangular (p x p)
///
/// so that Y spans the row space and Z the null space of C, and V the range. It serves step,
/// multipliers and reduced constraints alike: C^+ b = Y L^-1 V' b and (C')^+ g = V L^-T Y' g.
/// [Golub & Van Loan, Matrix Computations, 5.4.7]
///
/// Memory is taken only where a matrix is larger than all before.
class CompleteOrthogonal {
 public:
  /// A view of a factor, valid until the next Factor.
  using ConstMap = Eigen::Map<const Eigen::MatrixXd>;

  CompleteOrthogonal() = default;
  /// Pivots below rank_tolerance times the largest count as zero.
  CompleteOrthogonal(const Eigen::MatrixXd& C, double rank_tolerance);

  /// Memory for C' [columns, rows], to be filled before Factor(), which overwrites it.
  Eigen::Map<Eigen::MatrixXd> Prepare(int rows, int columns);
  void Factor(double rank_tolerance);  ///< pivots below it times the largest count as zero
  /// Changes the rank of the C factored last; rank_tolerance >= that of Factor().
  void SetRank(double rank_tolerance);
  /// Makes the solves that follow minimise with damping, >= 0; Factor() and SetRank() end it.
  void SetDamping(double damping) noexcept;

  int rank() const { return rank_; }                        ///< of the C factored last
  ConstMap V() const { return {V_.data(), m_, rank_}; }     ///< [m, rank], orthonormal columns
  ConstMap L() const { return {L_.data(), rank_, rank_}; }  ///< [rank, rank], upper triangular
  ConstMap Y() const { return {Q_.data(), n_, rank_}; }  ///< [n, rank], orthonormal: what C' spans
  /// [n, n - rank], orthonormal: C Z = 0
  ConstMap Z() const { return {Q_.data() + n_ * rank_, n_, n_ - rank_}; }

  /// The shortest of the x [n] that minimise |C x - b|^2 + damping |x|^2, b [m].
  void Solve(const double* b, double* x) noexcept;
  Eigen::VectorXd Solve(const Eigen::VectorXd& b);  ///< the same, with memory for x

  /// The shortest of the mu [m] that minimise |C' mu - g|^2 + damping |mu|^2, g [n].
  void SolveTransposed(const double* g, double* mu) noexcept;
  Eigen::VectorXd SolveTransposed(const Eigen::VectorXd& g);  ///< the same, with memory for mu

 private:
  void FactorRows(double rank_tolerance);
  void FormRowSpace();
  void FactorRange();

  int m_ = 0, n_ = 0;
  int pivots_ = 0;  // that are not negligible
  int rank_ = 0;
  double damping_ = 0;
  std::vector<double> R_, tau_, squares_, direct_squares_;  // C' P = Q R, column by column
  std::vector<int> order_;                                  // P: the row of C that came k-th
  std::vector<double> Q_, range_, L_, V_, column_;
  std::vector<double> damped_, scratch_;  // factors of L'L + damping
};

}  // namespace vmech
