#include "vmech/kinematics/linear_algebra.h"

#include <Eigen/Cholesky>
#include <Eigen/QR>
#include <Eigen/SVD>
#include <algorithm>

namespace vmech {

VectorXd SolveSymmetric(const MatrixXd& H, const VectorXd& b) {
  return Eigen::LDLT<MatrixXd>(H).solve(b);
}

VectorXd MinimumNormSolution(const MatrixXd& A, const VectorXd& b) {
  return A.completeOrthogonalDecomposition().solve(b);
}

NullSpace FindNullSpace(const MatrixXd& A, double tolerance) {
  const Eigen::Index n = A.cols();
  if (A.rows() == 0 || n == 0) return {0, MatrixXd::Identity(n, n)};
  Eigen::ColPivHouseholderQR<MatrixXd> qr(A.transpose());
  // Eigen's threshold is relative to the largest pivot; where that is rounding, nothing counts.
  if (qr.maxPivot() <= tolerance) return {0, MatrixXd::Identity(n, n)};
  qr.setThreshold(tolerance / std::min(1.0, qr.maxPivot()));
  NullSpace space;
  space.rank = static_cast<int>(qr.rank());
  const MatrixXd Q = qr.householderQ() * MatrixXd::Identity(n, n);
  space.basis = Q.rightCols(n - space.rank);
  return space;
}

std::vector<int> MostIndependentRows(const MatrixXd& A, int count) {
  const Eigen::ColPivHouseholderQR<MatrixXd> qr(A.transpose());
  std::vector<int> rows;
  for (int i = 0; i < count; ++i) rows.push_back(qr.colsPermutation().indices()[i]);
  return rows;
}

LeftSingularVectors FindLeftSingularVectors(const MatrixXd& A) {
  if (A.cols() == 0) return {VectorXd(0), MatrixXd::Identity(A.rows(), A.rows())};
  const Eigen::JacobiSVD<MatrixXd> svd(A, Eigen::ComputeFullU);
  return {svd.singularValues(), svd.matrixU()};
}

}  // namespace vmech
