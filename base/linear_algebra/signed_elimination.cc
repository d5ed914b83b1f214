#include "vmech/base/linear_algebra/signed_elimination.h"

#include <cmath>

namespace vmech {

int EliminateForSign(Eigen::MatrixXd& M, Eigen::MatrixXd& X, double* log) noexcept {
  const Eigen::Index n = M.rows(), columns = X.cols();
  int sign = 1;
  *log = 0;
  for (Eigen::Index k = 0; k < n; ++k) {
    Eigen::Index pivot = k;
    for (Eigen::Index i = k + 1; i < n; ++i) {
      if (std::abs(M(i, k)) > std::abs(M(pivot, k))) pivot = i;
    }
    if (!(std::abs(M(pivot, k)) > 0)) return 0;
    if (pivot != k) {
      M.row(k).swap(M.row(pivot));
      if (columns > 0) X.row(k).swap(X.row(pivot));
      sign = -sign;
    }
    if (M(k, k) < 0) sign = -sign;
    *log += std::log(std::abs(M(k, k)));
    for (Eigen::Index j = k + 1; j < n; ++j) {
      const double factor = M(k, j) / M(k, k);
      for (Eigen::Index i = k + 1; i < n; ++i) M(i, j) -= factor * M(i, k);
    }
    for (Eigen::Index j = 0; j < columns; ++j) {
      const double factor = X(k, j) / M(k, k);
      for (Eigen::Index i = k + 1; i < n; ++i) X(i, j) -= factor * M(i, k);
    }
  }
  return sign;
}

void BackSubstitute(const Eigen::MatrixXd& M, Eigen::MatrixXd& X) noexcept {
  for (Eigen::Index j = 0; j < X.cols(); ++j) {
    for (Eigen::Index k = M.rows() - 1; k >= 0; --k) {
      X(k, j) /= M(k, k);
      for (Eigen::Index i = 0; i < k; ++i) X(i, j) -= M(i, k) * X(k, j);
    }
  }
}

double Orthonormalise(Eigen::MatrixXd& X) noexcept {
  double log = 0;
  for (Eigen::Index j = 0; j < X.cols(); ++j) {
    for (Eigen::Index i = 0; i < j; ++i) X.col(j) -= X.col(i).dot(X.col(j)) * X.col(i);
    const double length = X.col(j).norm();
    log += std::log(length);
    X.col(j) /= length;
  }
  return log;
}

}  // namespace vmech
