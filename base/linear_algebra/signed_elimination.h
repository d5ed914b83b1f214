#pragma once

#include "vmech/base/eigen.h"

namespace vmech {

/// Gaussian elimination with pivoting in place, M to U and X to L^-1 X: sign of the determinant,
/// its logarithm in *log. 0, and neither is done, where M is singular to the last bit.
int EliminateForSign(Eigen::MatrixXd& M, Eigen::MatrixXd& X, double* log) noexcept;

/// X to U^-1 X, U the upper triangle of M.
void BackSubstitute(const Eigen::MatrixXd& M, Eigen::MatrixXd& X) noexcept;

/// Gram and Schmidt's method in place; returns the logarithm of the volume that the columns span.
double Orthonormalise(Eigen::MatrixXd& X) noexcept;

}  // namespace vmech
