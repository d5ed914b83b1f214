#include "vmech/solvers/saddle_system.h"

#include <algorithm>
#include <cassert>
#include <iterator>

#include "vmech/solvers/small_ldlt.h"

namespace vmech {
namespace {

constexpr int kSolves = 3;

// Kernels with sizes as in small_ldlt.h. Rows are whole registers.

/// G = w B'B, B [rows, n], both triangles.
template <int kSize>
void Gram(double w, const double* B, int rows, int size, double* G) noexcept {
  const int n = kSize > 0 ? kSize : size;
  for (int j = 0; j < n; ++j) {
    const double* B_j = B + j * rows;
    for (int i = j; i < n; ++i) {
      G[j * n + i] = G[i * n + j] = w * DotOfFours(B + i * rows, B_j, rows);
    }
  }
}

/// y = b + w C'd.
template <int kSize>
void AddTransposed(double w, const double* C, int rows, const double* d, const double* b, int size,
                   double* y) noexcept {
  const int n = kSize > 0 ? kSize : size;
  for (int j = 0; j < n; ++j) y[j] = b[j] + w * DotOfFours(C + j * rows, d, rows);
}

/// The solves. The multipliers act as forces s = C'mu, which grow by w C'(C x - d) = G x - w C'd:
/// they need C only in the end. `right` = b + w C'd; `total` becomes the sum of all x, x the last.
template <int kSize>
void Iterate(const double* L, const double* G, const double* b, const double* right, int size,
             double* s, double* total, double* x) noexcept {
  const int n = kSize > 0 ? kSize : size;
  for (int i = 0; i < n; ++i) s[i] = total[i] = 0;
  for (int k = 0; k < kSolves; ++k) {
    for (int i = 0; i < n; ++i) x[i] = right[i] - s[i];
    SolveLdlt<kSize>(L, n, x);
    for (int i = 0; i < n; ++i) s[i] -= right[i] - b[i];
    for (int j = 0; j < n; ++j) {
      total[j] += x[j];
      AddScaled(x[j], G + j * n, n, s);
    }
  }
}

}  // namespace

struct SaddleSystem::Kernels {
  decltype(&vmech::Gram<0>) gram;
  decltype(&FactorLdlt<0>) factor;
  decltype(&SolveLdlt<0>) solve;
  decltype(&AddTransposed<0>) add_transposed;
  decltype(&Iterate<0>) iterate;

  template <int kSize>
  static constexpr Kernels Of() {
    return {vmech::Gram<kSize>, FactorLdlt<kSize>, SolveLdlt<kSize>, AddTransposed<kSize>,
            Iterate<kSize>};
  }
  static const Kernels& ForSize(int size) noexcept {
    static constexpr Kernels kKernels[] = {Of<0>(), Of<1>(), Of<2>(), Of<3>(), Of<4>(),
                                           Of<5>(), Of<6>(), Of<7>(), Of<8>()};
    return kKernels[size < static_cast<int>(std::size(kKernels)) ? size : 0];
  }
};

SaddleSystem::SaddleSystem(int unknowns, int equations)
    : kernels_(Kernels::ForSize(unknowns)),
      G_(MatrixXd::Zero(unknowns, unknowns)),
      L_(G_),
      mu_(VectorXd::Zero(equations)),
      right_(VectorXd::Zero(unknowns)),
      s_(right_),
      total_(right_) {
  assert(equations % 4 == 0);
}

bool SaddleSystem::Factor(const MatrixXd& A, const MatrixXd& C) noexcept {
  const int n = size();
  if (C.rows() > 0) kernels_.gram(weight_, C.data(), equations(), n, G_.data());
  for (int i = 0; i < n * n; ++i) L_.data()[i] = A.data()[i] + G_.data()[i];
  return kernels_.factor(n, L_.data());
}

void SaddleSystem::Solve(const MatrixXd& C, const VectorXd& b, const VectorXd& d,
                         VectorXd* x) noexcept {
  const int n = size();
  if (C.rows() == 0) {
    std::copy_n(b.data(), n, x->data());
    kernels_.solve(L_.data(), n, x->data());
    return;
  }
  kernels_.add_transposed(weight_, C.data(), equations(), d.data(), b.data(), n, right_.data());
  kernels_.iterate(L_.data(), G_.data(), b.data(), right_.data(), n, s_.data(), total_.data(),
                   x->data());
  for (int i = 0; i < equations(); ++i) mu_[i] = -kSolves * weight_ * d[i];
  for (int j = 0; j < n; ++j) {
    AddScaled(weight_ * total_[j], C.data() + j * equations(), equations(), mu_.data());
  }
}

void SaddleSystem::Approach(const MatrixXd& C, const VectorXd& d, VectorXd* x) noexcept {
  x->setZero();
  if (C.rows() == 0) return;
  kernels_.add_transposed(weight_, C.data(), equations(), d.data(), x->data(), size(), x->data());
  kernels_.solve(L_.data(), size(), x->data());
}

void SaddleSystem::Gram(const MatrixXd& B, MatrixXd* G) const noexcept {
  kernels_.gram(1, B.data(), static_cast<int>(B.rows()), size(), G->data());
}

}  // namespace vmech
