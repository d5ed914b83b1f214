#include "vmech/solvers/null_motions.h"

#include <algorithm>

namespace vmech {
namespace {

// Pivots below this part of their diagonal are rounding.
constexpr double kNoPivot = 1e-13;
// Of the largest diagonal: a column that nothing depends on.
constexpr double kNoColumn = 1e-18;

}  // namespace

NullMotions::NullMotions(int unknowns)
    : L_(MatrixXd::Zero(unknowns, unknowns)),
      N_(MatrixXd::Zero(unknowns, unknowns)),
      diagonal_(VectorXd::Zero(unknowns)),
      Sn_(VectorXd::Zero(unknowns)) {}

void NullMotions::Find(const Linearization& at_x, const Held& held) noexcept {
  const int n = static_cast<int>(L_.rows());
  count_ = 0;
  Form(at_x);
  const double no_column = kNoColumn * (n > 0 ? diagonal_.maxCoeff() : 0);
  for (int j = 0; j < n; ++j) {
    const double pivot = L_(j, j);
    const bool none = pivot <= std::max(kNoPivot * diagonal_[j], no_column);
    if (held[j] || none) {
      L_.col(j).tail(n - j - 1).setZero();
      if (!held[j]) AddMotion(j);
      continue;
    }
    for (int k = j + 1; k < n; ++k) {
      if (held[k]) continue;
      const double scaled = L_(k, j) / pivot;
      for (int i = k; i < n; ++i) L_(i, k) -= scaled * L_(i, j);
    }
    L_.col(j).tail(n - j - 1) /= pivot;
  }
}

// J'J + C'C in the lower triangle of L.
void NullMotions::Form(const Linearization& at_x) noexcept {
  const int n = static_cast<int>(L_.rows());
  for (int j = 0; j < n; ++j) {
    for (int i = j; i < n; ++i) {
      L_(i, j) = at_x.J.col(i).dot(at_x.J.col(j)) + at_x.C.col(i).dot(at_x.C.col(j));
    }
    diagonal_[j] = L_(j, j);
  }
}

// Column j depends on those before it: L'n = e_j.
void NullMotions::AddMotion(int j) noexcept {
  auto n = N_.col(count_);
  n.setZero();
  n[j] = 1;
  for (int i = j - 1; i >= 0; --i) {
    double sum = 0;
    for (int k = i + 1; k <= j; ++k) sum += L_(k, i) * n[k];
    n[i] = -sum;
  }
  for (int k = 0; k < count_; ++k) n -= N_.col(k).dot(n) * N_.col(k);
  n.normalize();
  ++count_;
}

void NullMotions::Stiffen(double stiffness, MatrixXd* S) noexcept {
  const Eigen::Index size = S->rows();
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
