#pragma once

#include <vector>

#include "vmech/base/dual.h"
#include "vmech/base/pose.h"

namespace vmech {

// The dense decompositions that the offline analyses use, each compiled once. The pose kernels use
// none of them.

/// x of H x = b by L D L' with pivoting; H symmetric positive semidefinite.
VectorXd SolveSymmetric(const MatrixXd& H, const VectorXd& b);

/// The shortest x of H x = b without the eigenvectors of H whose eigenvalue is at most `floor`:
/// unknowns along them are zero. H symmetric positive semidefinite.
VectorXd SolveAboveFloor(const MatrixXd& H, const VectorXd& b, double floor);
/// With its derivative, as long as what is below the floor stays there: H x' = b' - H' x.
VectorX<Dual> SolveAboveFloor(const MatrixX<Dual>& H, const VectorX<Dual>& b, double floor);

/// The eigenvectors of H whose eigenvalue is at most `floor` [n, how many]. H as above.
MatrixXd FindKernel(const MatrixXd& H, double floor);

/// The shortest x that minimises |A x - b|, by complete orthogonal decomposition. Pivots below
/// `tolerance`, or `tolerance` times the largest, count as zero; 0 takes those of rounding.
VectorXd MinimumNormSolution(const MatrixXd& A, const VectorXd& b, double tolerance = 0);

/// Rank and null space of a matrix by Householder QR of its transpose with column pivoting.
struct NullSpace {
  int rank = 0;    ///< pivots that do not count as zero
  MatrixXd basis;  ///< [columns, columns - rank], orthonormal
};

/// For matrices whose entries are of the order of 1: pivots below `tolerance`, or `tolerance` times
/// the largest, count as zero. A matrix of nothing but rounding has rank 0.
NullSpace FindNullSpace(const MatrixXd& A, double tolerance);

/// A matrix A of the order of 1, and what is left of it when pivots that are small in the sense of
/// FindNullSpace count as zero.
struct RankSplit {
  int rank = 0;              ///< pivots that do not count as zero
  MatrixXd null_space;       ///< [columns, columns - rank], orthonormal: A N = 0
  MatrixXd left_null_space;  ///< [rows, rows - rank], orthonormal: U'A = 0
  MatrixXd pseudo_inverse;   ///< [columns, rows]
};
/// Splits A; `tolerance` as of FindNullSpace.
RankSplit SplitByRank(const MatrixXd& A, double tolerance);

/// `count` rows of A, one after the other the one that is farthest from the span of those before;
/// of rows that are alike but for rounding, the first.
std::vector<int> MostIndependentRows(const MatrixXd& A, int count);

/// Singular values, largest first, and all left singular vectors [rows, rows].
struct LeftSingularVectors {
  VectorXd values;   ///< [min(rows, columns)], >= 0
  MatrixXd vectors;  ///< [rows, rows], a column each
};
/// The singular values and left singular vectors of A.
LeftSingularVectors FindLeftSingularVectors(const MatrixXd& A);

}  // namespace vmech
