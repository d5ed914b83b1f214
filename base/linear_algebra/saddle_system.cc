#include "vmech/base/linear_algebra/saddle_system.h"

#include <algorithm>
#include <cassert>
#include <iterator>

#include "vmech/base/linear_algebra/small_ldlt.h"

namespace vmech {
namespace {

constexpr int kSolves = 3;

// Kernels with sizes as in small_ldlt.h, and so are the rows: whole registers.

/// G = w B'B, B [rows, n], both triangles.
template <int kSize, int kRows>
void Gram(double w, const double* B, int rows, int size, double* G) noexcept {
  const int n = kSize > 0 ? kSize : size, m = kRows > 0 ? kRows : rows;
  for (int j = 0; j < n; ++j) {
    const double* B_j = B + j * m;
    const double square = G[j * n + j] = w * DotOfDouble4(B_j, B_j, m);
    if (kSize == 0 && square == 0) {
      for (int i = j + 1; i < n; ++i) G[j * n + i] = G[i * n + j] = 0;
      continue;
    }
    for (int i = j + 1; i < n; ++i) {
      G[j * n + i] = G[i * n + j] = w * DotOfDouble4(B + i * m, B_j, m);
    }
  }
}

/// A += B'B, B [8, n].
template <int kSize>
void AddGramOfEight(const double* B, int size, double* A) noexcept {
  const int n = kSize > 0 ? kSize : size;
  for (int j = 0; j < n; ++j) {
    A[j * n + j] += DotOfDouble4(B + j * 8, B + j * 8, 8);
    for (int i = j + 1; i < n; ++i) {
      A[i * n + j] = A[j * n + i] += DotOfDouble4(B + i * 8, B + j * 8, 8);
    }
  }
}

/// L of A + G.
template <int kSize>
bool FactorSum(const double* A, const double* G, int size, double* L) noexcept {
  return FactorLdlt<kSize>(
      size, [&](int k) { return A[k] + G[k]; }, L);
}

/// mu = w (C t - s d).
template <int kSize, int kRows>
void Multiply(double w, const double* C, int rows, const double* t, double s, const double* d,
              int size, double* mu) noexcept {
  const int n = kSize > 0 ? kSize : size, m = kRows > 0 ? kRows : rows;
  for (int i = 0; i < m; i += 4) {
    Double4 sum = -s * LoadDouble4(d + i);
    for (int j = 0; j < n; ++j) sum += t[j] * LoadDouble4(C + j * m + i);
    StoreDouble4(w * sum, mu + i);
  }
}

/// y += A x, four rows at a time, which stay in registers.
template <int kSize>
void AddProduct(const double* A, const double* x, int size, double* y) noexcept {
  const int n = kSize > 0 ? kSize : size;
  int i = 0;
  for (; i + 4 <= n; i += 4) {
    Double4 sum = LoadDouble4(y + i);
    for (int j = 0; j < n; ++j) sum += x[j] * LoadDouble4(A + j * n + i);
    StoreDouble4(sum, y + i);
  }
  for (; i < n; ++i) {
    double sum = y[i];
    for (int j = 0; j < n; ++j) sum += A[j * n + i] * x[j];
    y[i] = sum;
  }
}

/// y = b + w C'd.
template <int kSize, int kRows>
void AddTransposed(double w, const double* C, int rows, const double* d, const double* b, int size,
                   double* y) noexcept {
  const int n = kSize > 0 ? kSize : size, m = kRows > 0 ? kRows : rows;
  for (int j = 0; j < n; ++j) y[j] = b[j] + w * DotOfDouble4(C + j * m, d, m);
}

/// The solves. The multipliers act as forces C'mu = b - A x, so that C is needed only in the end:
/// (A + w C'C) x+ = A x + w C'd. `right` = b + w C'd; `total` becomes the sum of all x. `scratch`
/// is for sizes not known here.
template <int kSize>
void Iterate(const double* L, const double* A, const double* b, const double* right, int size,
             double* scratch, double* total, double* x) noexcept {
  const int n = kSize > 0 ? kSize : size;
  double registers[kSize > 0 ? kSize : 1];
  double* const y = kSize > 0 ? registers : scratch;
  std::copy_n(right, n, y);
  SolveLdlt<kSize>(L, n, y);
  std::copy_n(y, n, total);
  for (int k = 1; k < kSolves; ++k) {
    if constexpr (kSize > 0) {
      double next[kSize];
      Unrolled<kSize>([&](auto i) {
        next[i] = right[i] - b[i];
        Unrolled<kSize>([&](auto j) { next[i] += A[j * n + i] * y[j]; });
      });
      Unrolled<kSize>([&](auto i) { y[i] = next[i]; });
    } else {
      std::copy_n(y, n, x);
      for (int i = 0; i < n; ++i) y[i] = right[i] - b[i];
      AddProduct<0>(A, x, n, y);
    }
    SolveLdlt<kSize>(L, n, y);
    for (int i = 0; i < n; ++i) total[i] += y[i];
  }
  std::copy_n(y, n, x);
}

}  // namespace

struct SaddleSystem::Kernels {
  decltype(&Gram<0, 0>) gram;
  decltype(&AddGramOfEight<0>) add_gram_of_eight;
  decltype(&FactorSum<0>) factor_sum;
  decltype(&SolveLdlt<0>) solve;
  decltype(&AddTransposed<0, 0>) add_transposed;
  decltype(&Multiply<0, 0>) multiply;
  decltype(&AddProduct<0>) add_product;
  decltype(&Iterate<0>) iterate;

  template <int kSize, int kRows>
  static constexpr Kernels Of() {
    return {
        Gram<kSize, kRows>,          AddGramOfEight<kSize>,  FactorSum<kSize>,  SolveLdlt<kSize>,
        AddTransposed<kSize, kRows>, Multiply<kSize, kRows>, AddProduct<kSize>, Iterate<kSize>};
  }
  template <int kRows>
  static const Kernels& ForSize(int size) noexcept {
    static constexpr Kernels kKernels[] = {Of<0, kRows>(), Of<1, kRows>(), Of<2, kRows>(),
                                           Of<3, kRows>(), Of<4, kRows>(), Of<5, kRows>(),
                                           Of<6, kRows>(), Of<7, kRows>(), Of<8, kRows>()};
    return kKernels[size < static_cast<int>(std::size(kKernels)) ? size : 0];
  }
  static const Kernels& For(int size, int rows) noexcept {
    return rows == 4 ? ForSize<4>(size) : rows == 8 ? ForSize<8>(size) : ForSize<0>(size);
  }
};

SaddleSystem::SaddleSystem(int unknowns, int equations)
    : kernels_(Kernels::For(unknowns, equations)),
      equations_(equations),
      G_(MatrixXd::Zero(unknowns, unknowns)),
      L_(G_),
      right_(VectorXd::Zero(unknowns)),
      scratch_(right_),
      total_(right_) {
  assert(equations % 4 == 0);
}

void SaddleSystem::SetConstraints(const MatrixXd& C) noexcept {
  if (equations_ > 0) kernels_.gram(weight_, C.data(), equations_, size(), G_.data());
}

bool SaddleSystem::Factor(const MatrixXd& A) noexcept {
  return kernels_.factor_sum(A.data(), G_.data(), size(), L_.data());
}

void SaddleSystem::Solve(const MatrixXd& A, const MatrixXd& C, const VectorXd& b, const VectorXd& d,
                         VectorXd* x) noexcept {
  const int n = size();
  if (equations_ == 0) return SolveOnce(C, b, d, x);
  kernels_.add_transposed(weight_, C.data(), equations_, d.data(), b.data(), n, right_.data());
  kernels_.iterate(L_.data(), A.data(), b.data(), right_.data(), n, scratch_.data(), total_.data(),
                   x->data());
}

void SaddleSystem::ComputeMultipliers(const MatrixXd& C, const VectorXd& d,
                                      VectorXd* mu) const noexcept {
  kernels_.multiply(weight_, C.data(), equations_, total_.data(), kSolves, d.data(), size(),
                    mu->data());
}

void SaddleSystem::SolveOnce(const MatrixXd& C, const VectorXd& b, const VectorXd& d,
                             VectorXd* x) noexcept {
  const int n = size();
  std::copy_n(b.data(), n, x->data());
  if (equations_ > 0) {
    kernels_.add_transposed(weight_, C.data(), equations_, d.data(), b.data(), n, x->data());
  }
  kernels_.solve(L_.data(), n, x->data());
}

void SaddleSystem::AddGram(const MatrixXd& B, MatrixXd* A) const noexcept {
  assert(B.rows() == 8);
  kernels_.add_gram_of_eight(B.data(), size(), A->data());
}

void SaddleSystem::Product(const MatrixXd& A, const VectorXd& x, VectorXd* y) const noexcept {
  std::fill_n(y->data(), size(), 0.0);
  kernels_.add_product(A.data(), x.data(), size(), y->data());
}

}  // namespace vmech
