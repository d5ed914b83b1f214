#pragma once

#include <stdexcept>
#include <string_view>
#include <vector>

#include "vmech/mechanisms/expressions/unit.h"

namespace vmech {

/// What is wrong with an expression, in words; the place is known to who asked for its value.
class ExpressionError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// The units in which numbers without a unit count: those of a file.
class CountingUnits {
 public:
  CountingUnits() = default;
  /// `base` are the units of length, angle, mass and time; `named` come before their products.
  CountingUnits(const Unit& length, const Unit& angle, const Unit& mass, const Unit& time,
                std::vector<Unit> named);
  const Unit& angle() const { return angle_; }  ///< of bare angles
  /// The unit that a file has for a dimension.
  Unit Of(const Dimension& dimension) const;

 private:
  Unit length_{1, {1}}, angle_{1, {0, 0, 0, 1}}, mass_{1, {0, 1}}, time_{1, {0, 0, 1}};
  std::vector<Unit> named_;
};

/// The value of an expression. T is double, or Dual for a derivative.
///
/// A number to which nobody gave a unit is `bare`. It counts in the unit of what it is added to or
/// compared with, and of the place where it stands, as a number that is typed there does. What has
/// a unit keeps it: products multiply the units, sums need the same dimension.
template <typename T>
struct Quantity {
  T figure = T(0);       ///< in `unit`
  Unit unit;             ///< SI = unit.factor * figure, unless it is bare
  bool bare = true;      ///< has no unit, not even that of a ratio
  bool radians = false;  ///< a bare number with pi in it: as an angle it counts in radians
};

/// a + b, of the same dimension. @throws ExpressionError
template <typename T>
Quantity<T> Sum(const Quantity<T>& a, const Quantity<T>& b, const CountingUnits& units);
/// a b, with the product of the units. @throws ExpressionError
template <typename T>
Quantity<T> Product(const Quantity<T>& a, const Quantity<T>& b);
/// a / b, with the ratio of the units. @throws ExpressionError
template <typename T>
Quantity<T> Ratio(const Quantity<T>& a, const Quantity<T>& b);
/// a ^ b, where b has no unit. @throws ExpressionError
template <typename T>
Quantity<T> Power(const Quantity<T>& a, const Quantity<T>& b);
/// A function by its name, of as many arguments as it takes. @throws ExpressionError
template <typename T>
Quantity<T> Call(std::string_view function, const std::vector<Quantity<T>>& arguments,
                 const CountingUnits& units);

/// How many arguments a function has; 0 if there is none of this name.
int ArgumentsOf(std::string_view function);

/// The figure in a unit that a place of a file asks for. @throws ExpressionError if the dimensions
/// differ or it is not finite.
template <typename T>
T FigureIn(const Quantity<T>& value, const Unit& asked);

}  // namespace vmech
