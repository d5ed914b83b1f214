#pragma once

#include <cmath>

#include "vmech/base/eigen.h"

namespace vmech {

/// A number and its derivative by one parameter. As the number T of the kernels it takes a
/// derivative through the same lines as the value: exact to rounding, where differences of values
/// lose half of the digits. Comparisons look at the values.
struct Dual {
  double value = 0;
  double slope = 0;  ///< d value / d parameter

  Dual() = default;
  Dual(double constant) : value(constant) {}  // NOLINT: numbers mix with duals
  Dual(double value, double slope) : value(value), slope(slope) {}

  Dual operator-() const { return {-value, -slope}; }
  Dual& operator+=(const Dual& b) { return *this = *this + b; }
  Dual& operator-=(const Dual& b) { return *this = *this - b; }
  Dual& operator*=(const Dual& b) { return *this = *this * b; }
  Dual& operator/=(const Dual& b) { return *this = *this / b; }
  friend Dual operator+(const Dual& a, const Dual& b) {
    return {a.value + b.value, a.slope + b.slope};
  }
  friend Dual operator-(const Dual& a, const Dual& b) {
    return {a.value - b.value, a.slope - b.slope};
  }
  friend Dual operator*(const Dual& a, const Dual& b) {
    return {a.value * b.value, a.slope * b.value + a.value * b.slope};
  }
  friend Dual operator/(const Dual& a, const Dual& b) {
    const double ratio = a.value / b.value;
    return {ratio, (a.slope - ratio * b.slope) / b.value};
  }
  friend bool operator<(const Dual& a, const Dual& b) { return a.value < b.value; }
  friend bool operator>(const Dual& a, const Dual& b) { return a.value > b.value; }
  friend bool operator<=(const Dual& a, const Dual& b) { return a.value <= b.value; }

  friend Dual Select(bool condition, const Dual& a, const Dual& b) { return condition ? a : b; }
  friend Dual abs(const Dual& a) { return a.value < 0 ? -a : a; }
  friend Dual min(const Dual& a, const Dual& b) { return b < a ? b : a; }
  friend Dual max(const Dual& a, const Dual& b) { return a < b ? b : a; }
  friend Dual sqrt(const Dual& a) {
    const double root = std::sqrt(a.value);
    return {root, root > 0 ? 0.5 * a.slope / root : 0};
  }
  friend Dual round(const Dual& a) { return std::round(a.value); }
  friend Dual atan2(const Dual& y, const Dual& x) {
    const double square = x.value * x.value + y.value * y.value;
    const double slope = square > 0 ? (x.value * y.slope - y.value * x.slope) / square : 0;
    return {std::atan2(y.value, x.value), slope};
  }
  friend void SinCos(const Dual& angle, Dual* sine, Dual* cosine) {
    const double s = std::sin(angle.value), c = std::cos(angle.value);
    *sine = {s, c * angle.slope};
    *cosine = {c, -s * angle.slope};
  }
};

}  // namespace vmech

template <>
struct Eigen::NumTraits<vmech::Dual> : Eigen::GenericNumTraits<vmech::Dual> {
  using Real = vmech::Dual;
  using NonInteger = vmech::Dual;
  using Nested = vmech::Dual;
  using Literal = double;
  enum {
    IsInteger = 0,
    IsSigned = 1,
    IsComplex = 0,
    RequireInitialization = 1,
    ReadCost = 2,
    AddCost = 2,
    MulCost = 3,
  };
};

// Numbers mix with duals in expressions.
template <typename Operation>
struct Eigen::ScalarBinaryOpTraits<double, vmech::Dual, Operation> {
  using ReturnType = vmech::Dual;
};
template <typename Operation>
struct Eigen::ScalarBinaryOpTraits<vmech::Dual, double, Operation> {
  using ReturnType = vmech::Dual;
};
