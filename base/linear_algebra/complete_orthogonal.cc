#include "vmech/base/linear_algebra/complete_orthogonal.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "vmech/base/linear_algebra/small_ldlt.h"

namespace vmech {
namespace {

// The reflection 1 - tau u u', u = [1; v], that takes x to beta e_1: beta and v replace x, tau is
// returned.
double MakeReflection(double* x, int n) noexcept {
  const double tail = Dot(x + 1, x + 1, n - 1), first = x[0];
  if (tail <= std::numeric_limits<double>::min()) return 0;
  const double beta = std::copysign(std::sqrt(first * first + tail), -first);
  const double inverse = 1 / (first - beta);
  for (int i = 1; i < n; ++i) x[i] *= inverse;
  x[0] = beta;
  return (beta - first) / beta;
}

// y -= tau u (u'y), u = [1; v]; what stands in u[0] is not looked at.
void Reflect(const double* u, double tau, int n, double* y) noexcept {
  const double s = tau * (y[0] + Dot(u + 1, y + 1, n - 1));
  y[0] -= s;
  AddScaled(-s, u + 1, 0, n - 1, y + 1);
}

// The first `columns` columns of the product of `count` reflections of vectors of n, which are
// stored column by column in u.
void FormProduct(const double* u, const double* tau, int n, int count, int columns,
                 double* product) noexcept {
  std::fill_n(product, n * columns, 0.0);
  for (int j = 0; j < columns; ++j) product[j * n + j] = 1;
  for (int k = count - 1; k >= 0; --k) {
    for (int j = k; j < columns; ++j) {
      Reflect(u + k * n + k, tau[k], n - k, product + j * n + k);
    }
  }
}

}  // namespace

CompleteOrthogonal::CompleteOrthogonal(const Eigen::MatrixXd& C, double rank_tolerance) {
  Prepare(static_cast<int>(C.rows()), static_cast<int>(C.cols())) = C.transpose();
  Factor(rank_tolerance);
}

Eigen::Map<Eigen::MatrixXd> CompleteOrthogonal::Prepare(int rows, int columns) {
  m_ = rows, n_ = columns;
  R_.resize(m_ * n_);
  return {R_.data(), n_, m_};
}

void CompleteOrthogonal::Factor(double rank_tolerance) {
  FactorRows(rank_tolerance);
  FormRowSpace();
  rank_ = -1;
  SetRank(rank_tolerance);
}

// C' P = Q R by reflections, the largest remaining column first, until what remains is negligible.
void CompleteOrthogonal::FactorRows(double rank_tolerance) {
  const int most = std::min(m_, n_);
  tau_.resize(most), squares_.resize(m_), direct_squares_.resize(m_), order_.resize(m_);
  std::iota(order_.begin(), order_.end(), 0);
  for (int j = 0; j < m_; ++j) {
    const double* const column = R_.data() + j * n_;
    squares_[j] = direct_squares_[j] = Dot(column, column, n_);
  }
  constexpr double kCancelled = 1.5e-8;  // half of the digits of what is left of a column are lost
  for (pivots_ = 0; pivots_ < most; ++pivots_) {
    const int k = pivots_;
    const auto largest = std::max_element(squares_.begin() + k, squares_.end());
    const int pivot = static_cast<int>(largest - squares_.begin());
    std::swap(squares_[k], squares_[pivot]);
    std::swap(direct_squares_[k], direct_squares_[pivot]);
    std::swap(order_[k], order_[pivot]);
    double* const R_k = R_.data() + k * n_;
    if (pivot != k) std::swap_ranges(R_k, R_k + n_, R_.data() + pivot * n_);
    tau_[k] = MakeReflection(R_k + k, n_ - k);
    if (!(std::abs(R_k[k]) > rank_tolerance * std::abs(R_[0]))) break;
    for (int j = k + 1; j < m_; ++j) {
      double* const R_j = R_.data() + j * n_;
      Reflect(R_k + k, tau_[k], n_ - k, R_j + k);
      squares_[j] = std::max(squares_[j] - R_j[k] * R_j[k], 0.0);
      if (squares_[j] > kCancelled * direct_squares_[j]) continue;
      squares_[j] = direct_squares_[j] = Dot(R_j + k + 1, R_j + k + 1, n_ - k - 1);
    }
  }
}

void CompleteOrthogonal::FormRowSpace() {
  Q_.resize(n_ * n_);
  FormProduct(R_.data(), tau_.data(), n_, pivots_, n_, Q_.data());
}

void CompleteOrthogonal::SetRank(double rank_tolerance) {
  damping_ = 0;
  int rank = 0;
  while (rank < pivots_ && std::abs(R_[rank * n_ + rank]) > rank_tolerance * std::abs(R_[0]))
    ++rank;
  if (rank == rank_) return;
  rank_ = rank;
  FactorRange();
}

// R1 the first `rank` rows of R: R1' = U L, hence C = (P U) L Y'.
void CompleteOrthogonal::FactorRange() {
  const int p = rank_;
  range_.resize(m_ * p), L_.resize(p * p), V_.resize(m_ * p), column_.resize(m_ + p);
  damped_.resize(p * p), scratch_.resize(2 * p);
  double* const tau = column_.data() + m_;
  for (int k = 0; k < p; ++k) {
    double* const range_k = range_.data() + k * m_;
    for (int i = 0; i < m_; ++i) range_k[i] = i < k ? 0 : R_[i * n_ + k];
  }
  for (int k = 0; k < p; ++k) {
    double* const range_k = range_.data() + k * m_;
    tau[k] = MakeReflection(range_k + k, m_ - k);
    for (int j = k + 1; j < p; ++j) {
      Reflect(range_k + k, tau[k], m_ - k, range_.data() + j * m_ + k);
    }
  }
  for (int k = 0; k < p; ++k) {
    for (int i = 0; i < p; ++i) L_[k * p + i] = i <= k ? range_[k * m_ + i] : 0;
  }
  FormProduct(range_.data(), tau, m_, p, p, V_.data());
  for (int k = 0; k < p; ++k) {
    double* const V_k = V_.data() + k * m_;
    std::copy_n(V_k, m_, column_.data());
    for (int i = 0; i < m_; ++i) V_k[order_[i]] = column_[i];
  }
}

void CompleteOrthogonal::SetDamping(double damping) noexcept {
  damping_ = damping;
  if (damping == 0) return;
  const int p = rank_;
  for (int j = 0; j < p; ++j) {
    for (int i = j; i < p; ++i) {
      damped_[j * p + i] = Dot(L_.data() + i * p, L_.data() + j * p, j + 1);
    }
    damped_[j * p + j] += damping;
  }
  // Not positive: so small that L alone is more exact.
  if (!FactorLdlt<0>(p, damped_.data())) damping_ = 0;
}

void CompleteOrthogonal::Solve(const double* b, double* x) noexcept {
  const int p = rank_;
  double *const t = scratch_.data(), *const s = t + p;
  MultiplyTransposed(V_.data(), m_, p, b, t);
  if (damping_ == 0) {
    for (int k = p - 1; k >= 0; --k) {
      s[k] = t[k] / L_[k * p + k];
      AddScaled(-s[k], L_.data() + k * p, 0, k, t);
    }
  } else {  // (L'L + damping)^-1 L'V' b
    for (int k = 0; k < p; ++k) s[k] = Dot(L_.data() + k * p, t, k + 1);
    SolveLdlt<0>(damped_.data(), p, s);
  }
  std::fill_n(x, n_, 0.0);
  AddProduct(Q_.data(), n_, p, s, x);
}

void CompleteOrthogonal::SolveTransposed(const double* g, double* mu) noexcept {
  const int p = rank_;
  double *const t = scratch_.data(), *const s = t + p;
  MultiplyTransposed(Q_.data(), n_, p, g, t);
  if (damping_ == 0) {
    for (int k = 0; k < p; ++k) s[k] = (t[k] - Dot(L_.data() + k * p, s, k)) / L_[k * p + k];
  } else {  // L (L'L + damping)^-1 Y' g
    SolveLdlt<0>(damped_.data(), p, t);
    std::fill_n(s, p, 0.0);
    for (int k = 0; k < p; ++k) AddScaled(t[k], L_.data() + k * p, 0, k + 1, s);
  }
  std::fill_n(mu, m_, 0.0);
  AddProduct(V_.data(), m_, p, s, mu);
}

Eigen::VectorXd CompleteOrthogonal::Solve(const Eigen::VectorXd& b) {
  Eigen::VectorXd x(n_);
  Solve(b.data(), x.data());
  return x;
}

Eigen::VectorXd CompleteOrthogonal::SolveTransposed(const Eigen::VectorXd& g) {
  Eigen::VectorXd mu(m_);
  SolveTransposed(g.data(), mu.data());
  return mu;
}

}  // namespace vmech
