#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "vmech/base/eigen.h"

namespace vmech {

/// Powers of metre, kilogram, second and radian. An angle is not a number here: a stiffness in
/// N m/rad is no torque. Powers need not be whole: the root of a length has one half.
struct Dimension {
  double length = 0, mass = 0, time = 0, angle = 0;

  bool none() const { return *this == Dimension{}; }
  Dimension Power(double exponent) const;
  friend Dimension operator*(const Dimension& a, const Dimension& b);
  friend Dimension operator/(const Dimension& a, const Dimension& b);
  friend bool operator==(const Dimension& a, const Dimension& b);
};

/// "length", "moment of inertia", "length^2 angle": for messages.
std::string NameOf(const Dimension& dimension);
/// The same with its article: "a length", "an angle".
std::string OneOf(const Dimension& dimension);

/// A unit: SI = factor * figure.
struct Unit {
  double factor = 1;
  Dimension dimension;

  operator double() const { return factor; }  // NOLINT: it scales figures
  friend Unit operator*(const Unit& a, const Unit& b) {
    return {a.factor * b.factor, a.dimension * b.dimension};
  }
  friend Unit operator/(const Unit& a, const Unit& b) {
    return {a.factor / b.factor, a.dimension / b.dimension};
  }
  template <typename Derived>
  friend auto operator*(const Unit& unit, const Eigen::MatrixBase<Derived>& figures) {
    return unit.factor * figures;
  }
  Unit Power(double exponent) const;
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
  std::string symbol;
  double times = 1;
};
/// The unit as it is written.
NamedUnit NameOf(const Unit& unit);

}  // namespace vmech
