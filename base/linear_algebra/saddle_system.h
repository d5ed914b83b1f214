#pragma once

#include "vmech/base/eigen.h"

namespace vmech {

using Eigen::MatrixXd;
using Eigen::VectorXd;

/// The equations of motion under equality constraints, and of everything that looks like them,
///
///   A x + C' mu = b,   C x = d,
///
/// by the method of multipliers with one factorisation and without a rank decision: C may have
/// redundant rows, and A need only be positive definite where C leaves x free.
///
///   (A + w C'C) x = b + C'(w d - mu),   mu += w (C x - d)
///
/// What C x - d leaves shrinks by A over w C'C from one solve to the next: with a ratio of 1e5,
/// three leave 1e-9 and less; beyond 1e7 rounding wins. Redundant rows get the smallest
/// multipliers. Made for some ten unknowns; all memory is taken by the constructor.
class SaddleSystem {
 public:
  /// `equations`: the rows of C, filled up with zeros to PaddedSize; so is d.
  SaddleSystem(int unknowns, int equations);

  /// w; equations are taken to be scaled alike.
  void SetWeight(double weight) noexcept { weight_ = weight; }

  /// Takes C [equations, unknowns]. Neither it nor A is copied: the same are to be given to what
  /// follows.
  void SetConstraints(const MatrixXd& C) noexcept;
  /// A [unknowns, unknowns], symmetric, both triangles. False if the sum is not positive definite.
  [[nodiscard]] bool Factor(const MatrixXd& A) noexcept;
  /// Writes x.
  void Solve(const MatrixXd& A, const MatrixXd& C, const VectorXd& b, const VectorXd& d,
             VectorXd* x) noexcept;
  /// The multipliers [equations] of the x found last, for the same d.
  void ComputeMultipliers(const MatrixXd& C, const VectorXd& d, VectorXd* mu) const noexcept;
  /// Writes what the first of the solves gives: x as near to C x = d as A over w C'C is to zero,
  /// and for b = 0 the smallest such x in the metric of A.
  void SolveOnce(const MatrixXd& C, const VectorXd& b, const VectorXd& d, VectorXd* x) noexcept;

  // For what has as many unknowns.
  /// A += B'B, B [8, unknowns].
  void AddGram(const MatrixXd& B, MatrixXd* A) const noexcept;
  /// y = A x.
  void Product(const MatrixXd& A, const VectorXd& x, VectorXd* y) const noexcept;

 private:
  struct Kernels;
  int size() const noexcept { return static_cast<int>(right_.size()); }

  const Kernels& kernels_;
  double weight_ = 1;
  int equations_;
  MatrixXd G_, L_;                    // w C'C and the factors
  VectorXd right_, scratch_, total_;  // total_: sum of the solves
};

}  // namespace vmech
