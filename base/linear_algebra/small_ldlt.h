#pragma once

#include <cstring>
#include <type_traits>
#include <utility>

#include "vmech/base/double4.h"

namespace vmech {

// Kernels for some ten unknowns, where calls cost more than the arithmetic behind them. Matrices
// are column by column without gaps. Where the size is given as kSize it is not looked at, and the
// compiler unrolls: twice as fast for the few unknowns of one loop. kSize = 0 is for any size.

inline Double4 LoadDouble4(const double* x) noexcept {
  Double4 four;
  std::memcpy(&four, x, sizeof(four));
  return four;
}
inline void StoreDouble4(const Double4& four, double* x) noexcept {
  std::memcpy(x, &four, sizeof(four));
}

/// a'b of whole registers, at least one.
inline double DotOfDouble4(const double* a, const double* b, int m) noexcept {
  Double4 sum = LoadDouble4(a) * LoadDouble4(b);
  for (int k = 4; k < m; k += 4) sum += LoadDouble4(a + k) * LoadDouble4(b + k);
  return (sum[0] + sum[2]) + (sum[1] + sum[3]);
}

/// a'b, four terms at a time and the rest of m without a loop.
inline double Dot(const double* a, const double* b, int m) noexcept {
  double rest = 0;
  if (m & 1) --m, rest = a[m] * b[m];
  if (m & 2) m -= 2, rest += a[m] * b[m] + a[m + 1] * b[m + 1];
  return m == 0 ? rest : DotOfDouble4(a, b, m) + rest;
}

/// y += s x for the entries from `from` to `to`, four at a time from multiples of four on: what one
/// call has stored, another loads as it is, without waiting for it to reach memory.
inline void AddScaled(double s, const double* x, int from, int to, double* y) noexcept {
  int k = from;
  for (; k % 4 != 0 && k < to; ++k) y[k] += s * x[k];
  for (; k + 4 <= to; k += 4) StoreDouble4(LoadDouble4(y + k) + s * LoadDouble4(x + k), y + k);
  for (; k < to; ++k) y[k] += s * x[k];
}

/// y = A'x, A [m, n].
inline void MultiplyTransposed(const double* A, int m, int n, const double* x, double* y) noexcept {
  for (int j = 0; j < n; ++j) y[j] = Dot(A + j * m, x, m);
}

/// y += A x, A [m, n].
inline void AddProduct(const double* A, int m, int n, const double* x, double* y) noexcept {
  for (int j = 0; j < n; ++j) AddScaled(x[j], A + j * m, 0, m, y);
}

/// body(0), body(1), .. body(kCount - 1), each with a constant for its argument: what they work on
/// stays in registers. A loop that the compiler vectorises waits for the stores of its last turn.
template <int kCount, typename Body>
inline void Unrolled(const Body& body) noexcept {
  [&]<int... k>(std::integer_sequence<int, k...>) {
    (body(std::integral_constant<int, k>()), ...);
  }
  (std::make_integer_sequence<int, kCount>());
}

/// A symmetric matrix, of which only the lower triangle is asked for, `entry(k)` its k-th number:
/// unit L, with 1/D on the diagonal and, where the size is not known here, L' above. False if it is
/// not positive definite.
template <int kSize, typename Entry>
[[nodiscard]] bool FactorLdlt(int size, const Entry& entry, double* L) noexcept {
  if constexpr (kSize > 0) {
    constexpr int n = kSize;
    double a[n * n];
    Unrolled<n>([&](auto j) {
      Unrolled<n - j>([&](auto below) { a[j * n + j + below] = entry(j * n + j + below); });
    });
    bool positive = true;
    Unrolled<n>([&](auto j) {
      positive &= a[j * n + j] > 0;
      const double inverse = 1 / a[j * n + j];
      a[j * n + j] = inverse;
      Unrolled<n - 1 - j>([&](auto below) {
        constexpr int k = j + 1 + below;
        const double scaled = a[j * n + k] * inverse;
        Unrolled<n - k>([&](auto i) { a[k * n + k + i] -= scaled * a[j * n + k + i]; });
        a[j * n + k] = scaled;
      });
    });
    Unrolled<n>([&](auto j) {
      Unrolled<n - j>([&](auto below) { L[j * n + j + below] = a[j * n + j + below]; });
    });
    return positive;
  } else {
    const int n = size;
    for (int k = 0; k < n * n; ++k) L[k] = entry(k);
    for (int j = 0; j < n; ++j) {
      double* const L_j = L + j * n;
      if (!(L_j[j] > 0)) return false;
      const double inverse = 1 / L_j[j];
      L_j[j] = inverse;
      for (int k = j + 1; k < n; ++k) {
        const double scaled = L[k * n + j] = L_j[k] * inverse;
        if (scaled != 0) AddScaled(-scaled, L_j, k, n, L + k * n);
      }
      for (int i = j + 1; i < n; ++i) L_j[i] = L[i * n + j];
    }
    return true;
  }
}

/// In place.
template <int kSize>
[[nodiscard]] bool FactorLdlt(int size, double* A) noexcept {
  return FactorLdlt<kSize>(
      size, [&](int k) { return A[k]; }, A);
}

/// x = (L D L')^-1 x.
template <int kSize>
void SolveLdlt(const double* L, int size, double* x) noexcept {
  if constexpr (kSize > 0) {
    constexpr int n = kSize;
    double y[n];
    Unrolled<n>([&](auto i) { y[i] = x[i]; });
    Unrolled<n>([&](auto j) {
      Unrolled<n - 1 - j>([&](auto i) { y[j + 1 + i] -= L[j * n + j + 1 + i] * y[j]; });
    });
    Unrolled<n>([&](auto from_below) {
      constexpr int j = n - 1 - from_below;
      y[j] *= L[j * n + j];
      // What was found last comes last: the others need not wait for it.
      Unrolled<n - 1 - j>([&](auto i) { y[j] -= L[j * n + n - 1 - i] * y[n - 1 - i]; });
    });
    Unrolled<n>([&](auto i) { x[i] = y[i]; });
  } else {
    const int n = size;
    for (int j = 0; j < n; ++j) AddScaled(-x[j], L + j * n, j + 1, n, x);
    for (int j = 0; j < n; ++j) x[j] *= L[j * n + j];
    for (int j = n - 1; j > 0; --j) AddScaled(-x[j], L + j * n, 0, j, x);
  }
}

}  // namespace vmech
