#pragma once

#include <vector>

namespace vmech {

/// A = L D L' of a symmetric matrix whose rows begin at a given column: the envelope. Linear in n
/// for chains of loops, and the plain dense method for a single loop. Without pivoting: for
/// matrices that are positive semidefinite, or saddle points [P C; C' 0] ordered so that every
/// leading block has C of full column rank. Sized once, then without allocation.
///
/// A pivot that cancels to less than `kSingular` of the terms it is the difference of is taken as
/// zero: its unknown is held at zero by Solve, and counted.
class EnvelopeLdlt {
 public:
  /// Of B'B the pivots are sin^2 of the angle between a column of B and the span of those before
  /// it: 1e-12 is a millionth of a radian, where roundoff (1e-16) leaves four digits of the pivot.
  static constexpr double kSingular = 1e-12;

  EnvelopeLdlt() = default;
  /// first[i] <= i is the first column of row i that may differ from zero.
  explicit EnvelopeLdlt(std::vector<int> first);

  int size() const { return static_cast<int>(first_.size()); }
  void SetZero();
  /// Entry (i, j), first[i] <= j <= i, to be filled before Factor.
  double& operator()(int i, int j) { return values_[start_[i] + j - first_[i]]; }
  /// Rows and columns are exchanged as needed to reach the lower triangle.
  void Add(int i, int j, double value) { (i >= j ? (*this)(i, j) : (*this)(j, i)) += value; }

  /// Replaces A by its factors.
  void Factor();
  /// Number of pivots taken as zero, and the smallest pivot relative to the terms in it.
  int zero_pivots() const { return zero_pivots_; }
  double smallest_pivot() const { return smallest_pivot_; }

  /// x = A^-1 x.
  void Solve(double* x) const;

 private:
  std::vector<int> first_;
  std::vector<int> start_;
  std::vector<double> values_;
  std::vector<double> inverse_pivot_;
  int zero_pivots_ = 0;
  double smallest_pivot_ = 1;
};

}  // namespace vmech
