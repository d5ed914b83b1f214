#pragma once

#include <cmath>
#include <type_traits>

#include "vmech/base/eigen.h"
#include "vmech/base/lanes.h"

namespace vmech {

/// A number and its derivative by one parameter. As the number T of the kernels it takes a
/// derivative through the same lines as the value: exact to rounding, where differences of values
/// lose half of the digits. Comparisons look at the values. N is double, or Lanes4 (lanes4.h).
template <typename N>
struct DualOf {
  N value = 0;  ///< of the function
  N slope = 0;  ///< d value / d parameter

  DualOf() = default;
  /// A number that does not depend on the parameter.
  DualOf(double constant) : value(constant) {}  // NOLINT: numbers mix with duals
  /// `slope` per unit of the parameter.
  DualOf(const N& value, const N& slope) : value(value), slope(slope) {}
  /// The same dual in every lane.
  template <typename M>
  requires(!std::is_same_v<M, N>) explicit DualOf(const DualOf<M>& dual)
      : value(dual.value), slope(dual.slope) {}

  /// `number(lane)`, a double or a Dual, in each lane.
  template <typename Number>
  static DualOf Of(const Number& number) {
    const DualOf<double> lanes[] = {number(0), number(1), number(2), number(3)};
    return {N::Of([&](int lane) { return lanes[lane].value; }),
            N::Of([&](int lane) { return lanes[lane].slope; })};
  }

  DualOf operator-() const { return {-value, -slope}; }              ///< of value and slope
  DualOf& operator+=(const DualOf& b) { return *this = *this + b; }  ///< by the rule for +
  DualOf& operator-=(const DualOf& b) { return *this = *this - b; }  ///< by the rule for -
  DualOf& operator*=(const DualOf& b) { return *this = *this * b; }  ///< by the product rule
  DualOf& operator/=(const DualOf& b) { return *this = *this / b; }  ///< by the quotient rule
  /// Slopes add.
  friend DualOf operator+(const DualOf& a, const DualOf& b) {
    return {a.value + b.value, a.slope + b.slope};
  }
  /// Slopes subtract.
  friend DualOf operator-(const DualOf& a, const DualOf& b) {
    return {a.value - b.value, a.slope - b.slope};
  }
  /// The product rule.
  friend DualOf operator*(const DualOf& a, const DualOf& b) {
    return {a.value * b.value, a.slope * b.value + a.value * b.slope};
  }
  /// The quotient rule; infinite or NaN where b's value is zero.
  friend DualOf operator/(const DualOf& a, const DualOf& b) {
    const N ratio = a.value / b.value;
    return {ratio, (a.slope - ratio * b.slope) / b.value};
  }
  /// Compares values and slopes: Eigen looks for factors of zero and one by it.
  friend bool operator==(const DualOf& a, const DualOf& b) {
    return a.value == b.value && a.slope == b.slope;
  }
  /// Compares the values alone.
  friend auto operator<(const DualOf& a, const DualOf& b) { return a.value < b.value; }
  /// Compares the values alone.
  friend auto operator>(const DualOf& a, const DualOf& b) { return a.value > b.value; }
  /// Compares the values alone.
  friend auto operator<=(const DualOf& a, const DualOf& b) { return a.value <= b.value; }

  /// Value and slope of `a` where the condition holds, else those of `b`.
  template <typename Condition>
  friend DualOf Select(const Condition& condition, const DualOf& a, const DualOf& b) {
    return {Select(condition, a.value, b.value), Select(condition, a.slope, b.slope)};
  }
  /// Slope as of a at zero.
  friend DualOf abs(const DualOf& a) { return Select(a.value < N(0), -a, a); }
  /// With the slope of the lesser; a's if equal.
  friend DualOf min(const DualOf& a, const DualOf& b) { return Select(b < a, b, a); }
  /// With the slope of the greater; a's if equal.
  friend DualOf max(const DualOf& a, const DualOf& b) { return Select(a < b, b, a); }
  /// Slope 0 at zero, where there is none.
  friend DualOf sqrt(const DualOf& a) {
    using std::sqrt;
    const N root = sqrt(a.value), zero(0);
    return {root, Select(root > zero, N(N(0.5) * a.slope / root), zero)};
  }
  /// The exponent is a constant.
  friend DualOf pow(const DualOf& a, double exponent) {
    using std::pow;
    return {pow(a.value, exponent), exponent * pow(a.value, exponent - 1) * a.slope};
  }
  /// Slope 0: steps are not differentiated.
  friend DualOf round(const DualOf& a) {
    using std::round;
    return {round(a.value), N(0)};
  }
  /// In (-pi, pi]. Slope 0 at the origin, where there is none.
  friend DualOf atan2(const DualOf& y, const DualOf& x) {
    using std::atan2;
    const N square = x.value * x.value + y.value * y.value, zero(0);
    const N slope = (x.value * y.slope - y.value * x.slope) / square;
    return {atan2(y.value, x.value), Select(square > zero, slope, zero)};
  }
  /// Both at once; `angle` in radians.
  friend void SinCos(const DualOf& angle, DualOf* sine, DualOf* cosine) {
    N s, c;
    SinCos(angle.value, &s, &c);
    *sine = {s, c * angle.slope};
    *cosine = {c, -s * angle.slope};
  }
};

/// A number with its derivatives.
using Dual = DualOf<double>;

/// Whether T is a number with derivatives.
template <typename T>
inline constexpr bool kIsDual = false;
/// A DualOf is a number with derivatives.
template <typename N>
inline constexpr bool kIsDual<DualOf<N>> = true;

/// A dual has as many lanes as its value.
template <typename N>
inline constexpr int kLanesOf<DualOf<N>> = kLanesOf<N>;
/// The value, without the slope, of one lane.
template <typename N>
double Lane(const DualOf<N>& number, int lane) {
  return Lane(number.value, lane);
}

}  // namespace vmech

/// @cond
template <typename N>
struct Eigen::NumTraits<vmech::DualOf<N>> : Eigen::GenericNumTraits<vmech::DualOf<N>> {
  using Real = vmech::DualOf<N>;
  using NonInteger = vmech::DualOf<N>;
  using Nested = vmech::DualOf<N>;
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
template <typename N, typename Operation>
struct Eigen::ScalarBinaryOpTraits<double, vmech::DualOf<N>, Operation> {
  using ReturnType = vmech::DualOf<N>;
};
template <typename N, typename Operation>
struct Eigen::ScalarBinaryOpTraits<vmech::DualOf<N>, double, Operation> {
  using ReturnType = vmech::DualOf<N>;
};
/// @endcond
