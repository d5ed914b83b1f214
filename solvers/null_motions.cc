#include "vmech/solvers/null_motions.h"

#include <algorithm>
#include <cmath>

namespace vmech {
namespace {

// Pivots below this part of their diagonal are rounding.
constexpr double kNoPivot = 1e-13;
// Of the largest diagonal: nothing depends on a column without more.
constexpr double kNoColumn = 1e-18;

}  // namespace

NullMotions::NullMotions(int unknowns)
    : A_(MatrixXd::Zero(unknowns, unknowns)),
      L_(MatrixXd::Zero(unknowns, unknowns)),
      N_(MatrixXd::Zero(unknowns, unknowns)),
      diagonal_(VectorXd::Zero(unknowns)),
      Sn_(VectorXd::Zero(unknowns)),
      order_(VectorXi::Zero(unknowns)),
      least_(unknowns) {
  eliminated_.setConstant(unknowns, false);
}

void NullMotions::Find(const Linearization& at_x, const Held& held) noexcept {
  Form(at_x, held);
  rank_ = count_ = 0;
  for (int pivot = LargestPivot(); pivot >= 0; pivot = LargestPivot()) Eliminate(pivot);
  for (int j = 0; j < A_.rows(); ++j) {
    if (!eliminated_[j]) AddMotion(j);
  }
  if (!held.any()) least_ = std::min(least_, count_);
}

// What is held counts as eliminated from the beginning.
void NullMotions::Form(const Linearization& at_x, const Held& held) noexcept {
  const Eigen::Index n = A_.rows();
  for (Eigen::Index j = 0; j < n; ++j) {
    for (Eigen::Index i = j; i < n; ++i) {
      A_(i, j) = at_x.J.col(i).dot(at_x.J.col(j)) + at_x.C.col(i).dot(at_x.C.col(j));
      A_(j, i) = A_(i, j);
    }
    diagonal_[j] = A_(j, j);
    eliminated_[j] = held[j];
  }
  for (double& diagonal : diagonal_) {
    diagonal = std::max(diagonal, kNoColumn / kNoPivot * diagonal_.maxCoeff());
  }
}

// The unknown that depends least on those that are eliminated; -1 where all depend on them.
int NullMotions::LargestPivot() const noexcept {
  int best = -1;
  double largest = kNoPivot;
  for (int j = 0; j < A_.rows(); ++j) {
    if (eliminated_[j] || !(A_(j, j) > largest * diagonal_[j])) continue;
    largest = A_(j, j) / diagonal_[j];
    best = j;
  }
  return best;
}

void NullMotions::Eliminate(int pivot) noexcept {
  const Eigen::Index n = A_.rows();
  auto l = L_.col(rank_);
  eliminated_[pivot] = true;
  for (Eigen::Index k = 0; k < n; ++k) l[k] = eliminated_[k] ? 0 : A_(k, pivot) / A_(pivot, pivot);
  for (Eigen::Index k = 0; k < n; ++k) {
    if (l[k] == 0) continue;
    for (Eigen::Index i = 0; i < n; ++i) A_(i, k) -= l[k] * A_(i, pivot);
  }
  order_[rank_++] = pivot;
}

// Unknown j depends on those that are eliminated: L'n = e_j.
void NullMotions::AddMotion(int j) noexcept {
  auto n = N_.col(count_);
  n.setZero();
  n[j] = 1;
  for (int s = rank_ - 1; s >= 0; --s) n[order_[s]] = -L_.col(s).dot(n);
  for (int k = 0; k < count_; ++k) n -= N_.col(k).dot(n) * N_.col(k);
  n.normalize();
  ++count_;
}

// Leaves those combinations of the motions that S does not couple to the one along which it curves
// most.
void NullMotions::DropMostCurved(const MatrixXd& S) noexcept {
  const auto curvature = [&](int i, int k) {
    for (Eigen::Index j = 0; j < S.cols(); ++j) Sn_[j] = S.col(j).dot(N_.col(k));
    return Sn_.dot(N_.col(i));
  };
  int dropped = 0;
  double largest = curvature(0, 0);
  for (int k = 1; k < count_; ++k) {
    const double along_k = curvature(k, k);
    if (std::abs(along_k) > std::abs(largest)) largest = along_k, dropped = k;
  }
  N_.col(dropped).swap(N_.col(--count_));
  for (int k = 0; k < count_; ++k) {
    if (largest != 0) N_.col(k) -= curvature(k, count_) / largest * N_.col(count_);
    for (int i = 0; i < k; ++i) N_.col(k) -= N_.col(i).dot(N_.col(k)) * N_.col(i);
    N_.col(k).normalize();
  }
}

void NullMotions::Stiffen(double stiffness, MatrixXd* S) noexcept {
  const Eigen::Index size = S->rows();
  while (count_ > least_) DropMostCurved(*S);
  for (int k = 0; k < count_; ++k) {
    const auto n = N_.col(k);
    // (1 - n n') S (1 - n n') + s n n' = S - n u' - u n',   u = S n - (n'S n + s)/2 n
    for (Eigen::Index i = 0; i < size; ++i) Sn_[i] = S->col(i).dot(n);
    Sn_ -= 0.5 * (Sn_.dot(n) + stiffness) * n;
    for (Eigen::Index j = 0; j < size; ++j) {
      for (Eigen::Index i = 0; i < size; ++i) (*S)(i, j) -= n[i] * Sn_[j] + Sn_[i] * n[j];
    }
  }
}

}  // namespace vmech
