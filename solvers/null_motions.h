#pragma once

#include "vmech/base/eigen.h"
#include "vmech/solvers/optimality.h"

namespace vmech {

/// The steps that neither residuals nor constraints see, to first order: the null space N of
/// [J; C]. Mostly they lead along points that are all as good, as where a rod spins between its
/// ball joints. There the second derivatives S couple them to the other steps as long as a force
/// is left, so that J'J + S is indefinite however near the minimum is, and asks for long steps that
/// change nothing. Without S, rounding does.
///
/// Found in J'J + C'C by L D L' with pivoting, where pivots of rounding tell the motions: made for
/// some ten unknowns. All memory is taken by the constructor.
class NullMotions {
 public:
  using Held = Eigen::Matrix<bool, Eigen::Dynamic, 1>;  ///< [unknowns] true: stays where it is

  explicit NullMotions(int unknowns);  ///< the size of a step

  /// At a point; unknowns that are held do not move.
  void Find(const Linearization& at_x, const Held& held) noexcept;

  /// Forgets how few there were elsewhere: another solve begins.
  void ForgetFewest() noexcept { least_ = static_cast<int>(A_.rows()); }

  int count() const noexcept { return count_; }  ///< how many were found
  /// One of them, of length 1 and square to the others.
  auto motion(int k) const noexcept { return N_.col(k); }

  /// S to P S P + stiffness N N', P = 1 - N N': a step of least norm, as far as it is not seen. If
  /// there are more motions here than somewhere before, as at a dead centre, those are left out of
  /// N along which S is curved most: there a force of the hand makes the minimum.
  void Stiffen(double stiffness, MatrixXd* S) noexcept;

 private:
  void Form(const Linearization& at_x, const Held& held) noexcept;
  int LargestPivot() const noexcept;
  void Eliminate(int pivot) noexcept;
  void AddMotion(int j) noexcept;
  void DropMostCurved(const MatrixXd& S) noexcept;

  using VectorXi = Eigen::Matrix<int, Eigen::Dynamic, 1>;
  int rank_ = 0, count_ = 0;
  MatrixXd A_, L_;  // what is left of J'J + C'C; a column of multipliers per pivot
  MatrixXd N_;      // the first count_ columns
  VectorXd diagonal_, Sn_;
  VectorXi order_;  // the unknowns that are eliminated, first to last
  Held eliminated_;
  int least_;  // count of the point with the fewest so far
};

}  // namespace vmech
