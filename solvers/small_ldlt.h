#pragma once

#include <cstring>

#include "vmech/solvers/four.h"

namespace vmech {

// Kernels for some ten unknowns, where calls cost more than the arithmetic behind them. Matrices
// are column by column without gaps. Where the size is given as kSize it is not looked at, and the
// compiler unrolls: twice as fast for the few unknowns of one loop. kSize = 0 is for any size.

inline Four LoadFour(const double* x) noexcept {
  Four four;
  std::memcpy(&four, x, sizeof(four));
  return four;
}
inline void StoreFour(const Four& four, double* x) noexcept {
  std::memcpy(x, &four, sizeof(four));
}

/// a'b of whole registers, at least one.
inline double DotOfFours(const double* a, const double* b, int m) noexcept {
  Four sum = LoadFour(a) * LoadFour(b);
  for (int k = 4; k < m; k += 4) sum += LoadFour(a + k) * LoadFour(b + k);
  return (sum[0] + sum[2]) + (sum[1] + sum[3]);
}

/// a'b, four terms at a time and the rest of m without a loop.
inline double Dot(const double* a, const double* b, int m) noexcept {
  double rest = 0;
  if (m & 1) --m, rest = a[m] * b[m];
  if (m & 2) m -= 2, rest += a[m] * b[m] + a[m + 1] * b[m + 1];
  return m == 0 ? rest : DotOfFours(a, b, m) + rest;
}

/// y += s x.
inline void AddScaled(double s, const double* x, int m, double* y) noexcept {
  int k = 0;
  for (; k + 4 <= m; k += 4) StoreFour(LoadFour(y + k) + s * LoadFour(x + k), y + k);
  for (; k < m; ++k) y[k] += s * x[k];
}

/// The lower triangle of a symmetric matrix becomes unit L, with 1/D on the diagonal. False if it
/// is not positive definite.
template <int kSize>
[[nodiscard]] bool FactorLdlt(int size, double* L) noexcept {
  const int n = kSize > 0 ? kSize : size;
  for (int j = 0; j < n; ++j) {
    double* const L_j = L + j * n;
    if (!(L_j[j] > 0)) return false;
    const double inverse = 1 / L_j[j];
    L_j[j] = inverse;
    for (int k = j + 1; k < n; ++k) {
      const double scaled = L_j[k] * inverse;
      if constexpr (kSize > 0) {
        for (int i = k; i < n; ++i) L[k * n + i] -= scaled * L_j[i];
      } else if (scaled != 0) {
        AddScaled(-scaled, L_j + k, n - k, L + k * n + k);
      }
    }
    for (int i = j + 1; i < n; ++i) L_j[i] *= inverse;
  }
  return true;
}

/// x = (L D L')^-1 x.
template <int kSize>
void SolveLdlt(const double* L, int size, double* x) noexcept {
  const int n = kSize > 0 ? kSize : size;
  for (int j = 0; j < n; ++j) {
    if constexpr (kSize > 0) {
      for (int i = j + 1; i < n; ++i) x[i] -= L[j * n + i] * x[j];
    } else {
      AddScaled(-x[j], L + j * n + j + 1, n - j - 1, x + j + 1);
    }
  }
  for (int j = n - 1; j >= 0; --j) {
    x[j] *= L[j * n + j];
    if constexpr (kSize > 0) {
      for (int i = j + 1; i < n; ++i) x[j] -= L[j * n + i] * x[i];
    } else {
      x[j] -= Dot(L + j * n + j + 1, x + j + 1, n - j - 1);
    }
  }
}

}  // namespace vmech
