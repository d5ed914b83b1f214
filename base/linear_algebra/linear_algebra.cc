#include "vmech/base/linear_algebra/linear_algebra.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <Eigen/SVD>
#include <algorithm>

namespace vmech {

VectorXd SolveAboveFloor(const MatrixXd& H, const VectorXd& b, double floor) {
  if (H.cols() == 0) return VectorXd(0);
  const Eigen::SelfAdjointEigenSolver<MatrixXd> eigen(H);
  const auto counts = eigen.eigenvalues().array() > floor;
  const VectorXd inverse = counts.select(eigen.eigenvalues().array().inverse(), 0.0);
  return eigen.eigenvectors() *
         inverse.cwiseProduct(VectorXd(eigen.eigenvectors().transpose() * b));
}

VectorX<Dual> SolveAboveFloor(const MatrixX<Dual>& H, const VectorX<Dual>& b, double floor) {
  const auto value = [](const Dual& x) { return x.value; };
  const auto slope = [](const Dual& x) { return x.slope; };
  const MatrixXd H0 = H.unaryExpr(value);
  const VectorXd x = SolveAboveFloor(H0, b.unaryExpr(value), floor);
  const VectorXd open = b.unaryExpr(slope) - H.unaryExpr(slope) * x;
  const VectorXd dx = SolveAboveFloor(H0, open, floor);
  return x.binaryExpr(dx, [](double value, double slope) { return Dual(value, slope); });
}

MatrixXd FindKernel(const MatrixXd& H, double floor) {
  if (H.cols() == 0) return H;
  const Eigen::SelfAdjointEigenSolver<MatrixXd> eigen(H);  // eigenvalues increase
  return eigen.eigenvectors().leftCols((eigen.eigenvalues().array() <= floor).count());
}

VectorXd SolveSymmetric(const MatrixXd& H, const VectorXd& b) {
  return Eigen::LDLT<MatrixXd>(H).solve(b);
}

namespace {

using Orthogonal = Eigen::CompleteOrthogonalDecomposition<MatrixXd>;

/// Pivots below `tolerance`, or `tolerance` times the largest, count as zero. The largest is the
/// longest column.
Orthogonal Decomposed(const MatrixXd& A, double tolerance) {
  Orthogonal decomposition(A.rows(), A.cols());
  const double largest = A.colwise().norm().maxCoeff();
  if (tolerance > 0) decomposition.setThreshold(tolerance / std::min(1.0, largest));
  decomposition.compute(A);
  return decomposition;
}

}  // namespace

VectorXd MinimumNormSolution(const MatrixXd& A, const VectorXd& b, double tolerance) {
  if (A.rows() == 0 || A.cols() == 0) return VectorXd::Zero(A.cols());
  return Decomposed(A, tolerance).solve(b);
}

RankSplit SplitByRank(const MatrixXd& A, double tolerance) {
  const Eigen::Index m = A.rows(), n = A.cols();
  if (m == 0 || n == 0 || A.colwise().norm().maxCoeff() <= tolerance) {
    return {0, MatrixXd::Identity(n, n), MatrixXd::Identity(m, m), MatrixXd::Zero(n, m)};
  }
  const Orthogonal decomposition = Decomposed(A, tolerance);
  const Eigen::Index rank = decomposition.rank();
  const MatrixXd Q = decomposition.householderQ() * MatrixXd::Identity(m, m);
  const MatrixXd Z = decomposition.colsPermutation() * decomposition.matrixZ().transpose();
  return {static_cast<int>(rank), Z.rightCols(n - rank), Q.rightCols(m - rank),
          decomposition.pseudoInverse()};
}

NullSpace FindNullSpace(const MatrixXd& A, double tolerance) {
  const Eigen::Index n = A.cols();
  const NullSpace whole{0, MatrixXd::Identity(n, n)};
  if (A.size() == 0) return whole;
  Eigen::ColPivHouseholderQR<MatrixXd> qr(A.transpose());
  // Eigen's threshold is relative to the largest pivot; where that is rounding, nothing counts.
  if (qr.maxPivot() <= tolerance) return whole;
  qr.setThreshold(tolerance / std::min(1.0, qr.maxPivot()));
  const Eigen::Index rank = qr.rank();
  MatrixXd last = MatrixXd::Zero(n, n - rank);
  last.bottomRows(n - rank).setIdentity();
  return {static_cast<int>(rank), qr.householderQ() * last};
}

std::vector<int> MostIndependentRows(const MatrixXd& A, int count) {
  constexpr double kAlike = 1 - 1e-8;
  MatrixXd left = A;  // of each row, less its part along those chosen
  std::vector<int> rows;
  for (int i = 0; i < count; ++i) {
    const VectorXd size = left.rowwise().norm();
    const double enough = kAlike * size.maxCoeff();
    const auto first =
        std::find_if(size.begin(), size.end(), [&](double s) { return s >= enough; });
    rows.push_back(static_cast<int>(first - size.begin()));
    const VectorXd direction = left.row(rows.back()).transpose().stableNormalized();
    left -= (left * direction).eval() * direction.transpose();
    left.row(rows.back()).setZero();
  }
  return rows;
}

LeftSingularVectors FindLeftSingularVectors(const MatrixXd& A) {
  if (A.cols() == 0) return {VectorXd(0), MatrixXd::Identity(A.rows(), A.rows())};
  const Eigen::JacobiSVD<MatrixXd> svd(A, Eigen::ComputeFullU);
  return {svd.singularValues(), svd.matrixU()};
}

}  // namespace vmech
