#include "vmech/kinematics/inverse/branch_determinant.h"

#include <algorithm>
#include <cmath>

#include "vmech/base/linear_algebra/signed_elimination.h"
#include "vmech/base/linear_algebra/small_ldlt.h"

namespace vmech {
namespace {

/// det(A'A_ref) over the largest det(A'A) so far, below which a pose is near a dead centre: where
/// the hand moves the mechanism 30 times less than elsewhere.
constexpr double kNear = 1e-3;
/// Added to A'A_ref, as a part of its largest diagonal: exactly singular poses have logarithms too.
constexpr double kFloor = 1e-12;
constexpr int kInverseIterations = 4;

}  // namespace

BranchDeterminant::BranchDeterminant(Eigen::Index rows, Eigen::Index tangents)
    : A_(MatrixXd::Zero(PaddedSize(static_cast<int>(rows)), tangents)),
      product_(tangents, tangents),
      normal_(tangents) {}

void BranchDeterminant::Begin(const MatrixXd& J, const MatrixXd& C, const MatrixXd& unseen) {
  Stack(J, C);
  unseen_ = unseen;
  unseen_weight_ = A_.colwise().squaredNorm().maxCoeff();
  SetReference();
}

void BranchDeterminant::Take(const MatrixXd& J, const MatrixXd& C) noexcept {
  Stack(J, C);
  value_ = Evaluate();
}

void BranchDeterminant::Stack(const MatrixXd& J, const MatrixXd& C) noexcept {
  for (Eigen::Index j = 0; j < A_.cols(); ++j) {
    double* A_j = A_.data() + j * A_.rows();
    std::copy_n(J.data() + j * J.rows(), J.rows(), A_j);
    std::copy_n(C.data() + j * C.rows(), C.rows(), A_j + J.rows());
  }
}

/// With N the unseen motions, A N = 0, and M = A_ref'A + s N_ref N_ref',
///
///     det M = s^k det(N_ref'N) det(A_ref'A on the others),   M^-1 s N_ref = N (N_ref'N)^-1,
///
/// so that one elimination gives the determinant and N, which goes to unseen_.
double BranchDeterminant::Evaluate() noexcept {
  const int n = static_cast<int>(A_.cols()), rows = static_cast<int>(A_.rows());
  for (int j = 0; j < n; ++j) {
    for (int i = 0; i < n; ++i) {
      product_.data()[j * n + i] =
          DotOfDouble4(A_.data() + i * rows, A_reference_.data() + j * rows, rows);
    }
  }
  const bool some_unseen = unseen_.cols() > 0;
  if (some_unseen) {
    product_.transposeInPlace();
    AddUnseen(unseen_reference_);
    unseen_ = unseen_weight_ * unseen_reference_;
  }
  product_.diagonal().array() += kFloor * product_.diagonal().cwiseAbs().maxCoeff();
  double log = 0;
  const int sign = EliminateForSign(product_, unseen_, &log);
  if (some_unseen && sign == 0) unseen_ = unseen_reference_;
  if (some_unseen && sign != 0) {
    BackSubstitute(product_, unseen_);
    log += Orthonormalise(unseen_);
  }
  return sign * std::exp(log - log_reference_);
}

// product_ += s N N'
void BranchDeterminant::AddUnseen(const MatrixXd& N) noexcept {
  for (Eigen::Index k = 0; k < N.cols(); ++k) {
    for (Eigen::Index j = 0; j < N.rows(); ++j) {
      product_.col(j) += unseen_weight_ * N(j, k) * N.col(k);
    }
  }
}

void BranchDeterminant::SetReference() noexcept {
  A_reference_ = A_;
  unseen_reference_ = unseen_;
  log_reference_ = 0;
  log_reference_ = std::log(Evaluate());
  log_best_ = std::max(log_best_, log_reference_);
  value_ = 1;
}

bool BranchDeterminant::IsNearDeadCentre() const noexcept {
  return value_ * std::exp(log_reference_ - log_best_) < kNear;
}

/// By inverse iteration on A'A.
void BranchDeterminant::FindSoftMotion(VectorXd* motion) noexcept {
  product_ = A_.transpose().lazyProduct(A_);
  AddUnseen(unseen_);
  product_.diagonal().array() += kFloor * product_.diagonal().maxCoeff();
  normal_.compute(product_);
  *motion = VectorXd::LinSpaced(motion->size(), 1, 2);
  for (int i = 0; i < kInverseIterations; ++i) {
    normal_.solveInPlace(*motion);
    *motion /= motion->lpNorm<Eigen::Infinity>();
  }
}

}  // namespace vmech
