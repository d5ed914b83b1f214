#pragma once

#include <vector>

namespace vmech {

/// A = L D L' of a symmetric matrix whose rows begin at a given column: the envelope. Linear in n
/// for chains of loops, and the plain dense method for a single loop. Without pivoting: for
/// matrices that are positive semidefinite, or saddle points [P C; C' 0] ordered so that every
/// leading block has C of full column rank. Sized once, then without allocation.
///
/// T is double or Lanes4 (four matrices of one envelope).
///
/// A pivot that cancels to less than `kSingular` of the terms it is the difference of is taken as
/// zero: its unknown is held at zero by Solve, and counted.
template <typename T>
class EnvelopeLdlt {
 public:
  /// Of B'B the pivots are sin^2 of the angle between a column of B and the span of those before
  /// it: 1e-12 is a millionth of a radian, where roundoff (1e-16) leaves four digits of the pivot.
  static constexpr double kSingular = 1e-12;

  EnvelopeLdlt() = default;
  /// first[i] <= i is the first column of row i that may differ from zero.
  explicit EnvelopeLdlt(std::vector<int> first);

  int size() const { return static_cast<int>(first_.size()); }  ///< rows
  void SetZero();                                               ///< every entry that is stored
  /// Entry (i, j), first[i] <= j <= i, to be filled before Factor.
  T& operator()(int i, int j) { return values_[row_[i] + j]; }
  /// Rows and columns are exchanged as needed to reach the lower triangle.
  void Add(int i, int j, const T& value) { (i >= j ? (*this)(i, j) : (*this)(j, i)) += value; }

  /// Replaces A by its factors.
  void Factor();
  /// The smallest pivot relative to the terms in it; 0 if one was taken as zero.
  const T& smallest_pivot() const { return smallest_pivot_; }
  /// 1 / D(i); 0 if the pivot was taken as zero.
  const T& inverse_pivot(int i) const { return inverse_pivot_[i]; }

  /// x = A^-1 x.
  void Solve(T* x) const;
  /// z [size] with L'z = e_i: z_i = 1, nothing behind i, and z'A z is the pivot. Where that is zero
  /// A z = 0.
  void MotionOfPivot(int i, T* z) const;

 private:
  std::vector<int> first_;
  std::vector<int> row_;  ///< where A(i, 0) would be in values_
  std::vector<T> values_;
  std::vector<T> inverse_pivot_;
  std::vector<T> products_;  ///< L(i,j) D(j) of the row at work
  T smallest_pivot_ = T(1);
};

}  // namespace vmech
