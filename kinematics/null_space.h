#pragma once

#include <vector>

#include "vmech/mechanisms/pose.h"

namespace vmech {

/// Rank and null space of a matrix by Householder QR of its transpose with column pivoting.
struct NullSpace {
  int rank = 0;
  MatrixXd basis;            ///< [columns, columns - rank], orthonormal
  double smallest_kept = 0;  ///< last pivot that counted, relative to the largest
};

/// Pivots below `tolerance` times the largest count as zero.
NullSpace FindNullSpace(const MatrixXd& A, double tolerance);

/// The first `count` rows of A that column pivoting of A' chooses: the best-conditioned ones.
std::vector<int> MostIndependentRows(const MatrixXd& A, int count);

}  // namespace vmech
