#include "vmech/base/linear_algebra/complete_orthogonal.h"

#include <Eigen/QR>

namespace vmech {

CompleteOrthogonal::CompleteOrthogonal(const Eigen::MatrixXd& C, double rank_tolerance) {
  const Eigen::Index m = C.rows(), n = C.cols();
  if (m == 0 || n == 0) {
    V.resize(m, 0), L.resize(0, 0), Y.resize(n, 0), Z.setIdentity(n, n);
    return;
  }
  // C' P = [Y Z] [R1; 0]
  Eigen::ColPivHouseholderQR<Eigen::MatrixXd> rows(C.transpose());
  rows.setThreshold(rank_tolerance);
  const Eigen::Index p = rows.rank();
  const Eigen::MatrixXd Q = rows.householderQ() * Eigen::MatrixXd::Identity(n, n);
  Y = Q.leftCols(p);
  Z = Q.rightCols(n - p);
  // R1' = U L, hence C = (P U) L Y'
  const Eigen::MatrixXd R1 = rows.matrixR().topRows(p).triangularView<Eigen::Upper>();
  Eigen::HouseholderQR<Eigen::MatrixXd> range(R1.transpose());
  const Eigen::MatrixXd U = range.householderQ() * Eigen::MatrixXd::Identity(m, p);
  V = rows.colsPermutation() * U;
  L = range.matrixQR().topRows(p).triangularView<Eigen::Upper>();
}

Eigen::VectorXd CompleteOrthogonal::Solve(const Eigen::VectorXd& b, double damping) const {
  if (damping == 0) return Y * L.triangularView<Eigen::Upper>().solve(V.transpose() * b);
  // Y (L'L + damping)^-1 L'V' b
  return Y * Damped(damping).solve(L.transpose() * (V.transpose() * b));
}

Eigen::VectorXd CompleteOrthogonal::SolveTransposed(const Eigen::VectorXd& g,
                                                    double damping) const {
  if (damping == 0) {
    return V * L.transpose().triangularView<Eigen::Lower>().solve(Y.transpose() * g);
  }
  // V L (L'L + damping)^-1 Y' g
  return V * (L * Damped(damping).solve(Y.transpose() * g));
}

Eigen::LLT<Eigen::MatrixXd> CompleteOrthogonal::Damped(double damping) const {
  Eigen::MatrixXd square = L.transpose() * L;
  square.diagonal().array() += damping;
  return Eigen::LLT<Eigen::MatrixXd>(square);
}

}  // namespace vmech
