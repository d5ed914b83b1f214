#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "vmech/base/eigen.h"

namespace vmech {

/// Powers of metre, kilogram, second and radian. An angle is not a number here: a stiffness in
/// N m/rad is no torque. Powers need not be whole: the root of a length has one half.
struct Dimension {
  double length = 0, mass = 0, time = 0, angle = 0;  ///< exponents

  bool none() const { return *this == Dimension{}; }                   ///< of a plain number
  Dimension Power(double exponent) const;                              ///< every exponent times it
  friend Dimension operator*(const Dimension& a, const Dimension& b);  ///< exponents add
  friend Dimension operator/(const Dimension& a, const Dimension& b);  ///< exponents subtract
  friend bool operator==(const Dimension& a, const Dimension& b);      ///< every exponent is equal
};

/// "length", "moment of inertia", "length^2 angle": for messages.
std::string NameOf(const Dimension& dimension);
/// The same with its article: "a length", "an angle".
std::string OneOf(const Dimension& dimension);

/// A unit: SI = factor * figure.
struct Unit {
  double factor = 1;    ///< SI over figure
  Dimension dimension;  ///< of what it measures

  /// The factor.
  operator double() const { return factor; }  // NOLINT: it scales figures
  /// The unit of a product of figures.
  friend Unit operator*(const Unit& a, const Unit& b) {
    return {a.factor * b.factor, a.dimension * b.dimension};
  }
  /// The unit of a ratio of figures.
  friend Unit operator/(const Unit& a, const Unit& b) {
    return {a.factor / b.factor, a.dimension / b.dimension};
  }
  /// The figures in SI, without a dimension.
  template <typename Derived>
  friend auto operator*(const Unit& unit, const Eigen::MatrixBase<Derived>& figures) {
    return unit.factor * figures;
  }
  Unit Power(double exponent) const;  ///< the unit of that power of a figure
};

/// The unit of a symbol: m km cm mm um in ft, rad mrad deg rev, kg g mg t lb, s ms min h,
/// N kN mN lbf, rpm.
std::optional<Unit> FindUnit(std::string_view symbol);

/// A product of symbols with powers and at most one '/', as in "kg mm^2" or "N m/deg". None if a
/// symbol is not known.
std::optional<Unit> ParseUnit(std::string_view text);

/// A unit as text, "mm" or "kg m^2/s", and what a figure in `unit` is to be multiplied by to be one
/// in it: 1 where the unit has a name.
struct NamedUnit {
  std::string symbol;  ///< its name, or a product of names
  double times = 1;    ///< factor on a figure in the unit asked about
};
/// The unit as it is written.
NamedUnit NameOf(const Unit& unit);

}  // namespace vmech
