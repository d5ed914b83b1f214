#include "vmech/mechanisms/expressions/quantity.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "vmech/base/dual.h"

namespace vmech {
namespace {

constexpr Dimension kAngle{0, 0, 0, 1};
constexpr Unit kRadian{1, kAngle};

double ValueOf(double x) {
  return x;
}
double ValueOf(const Dual& x) {
  return x.value;
}

/// f(x), given the value and the derivative of f there.
double Applied(double /*x*/, double value, double /*slope*/) {
  return value;
}
Dual Applied(const Dual& x, double value, double slope) {
  return {value, x.slope == 0 ? 0 : slope * x.slope};
}

double PowerOf(double a, double b) {
  return std::pow(a, b);
}
Dual PowerOf(const Dual& a, const Dual& b) {
  const double value = std::pow(a.value, b.value);
  double slope = 0;
  if (a.slope != 0) slope += b.value * std::pow(a.value, b.value - 1) * a.slope;
  if (b.slope != 0) slope += value * std::log(a.value) * b.slope;
  return {value, slope};
}

double Atan2(double y, double x) {
  return std::atan2(y, x);
}
Dual Atan2(const Dual& y, const Dual& x) {
  return atan2(y, x);
}

template <typename T>
Quantity<T> WithUnit(T figure, const Unit& unit) {
  if (unit.dimension.none()) return {figure * T(unit.factor), {}, false, false};
  return {figure, unit, false, false};
}

/// The words for what a quantity is.
template <typename T>
std::string KindOf(const Quantity<T>& q) {
  return OneOf(q.unit.dimension);
}

/// A bare number in a unit.
template <typename T>
T BareIn(const Quantity<T>& bare, const Unit& unit) {
  const bool turn = bare.radians && unit.dimension == kAngle && unit.factor != 1;
  return turn ? bare.figure / T(unit.factor) : bare.figure;
}

/// The figure of b in the unit of a, which has one.
template <typename T>
T InUnitOf(const Quantity<T>& a, const Quantity<T>& b, const CountingUnits& units,
           std::string_view what) {
  if (b.bare) {
    const Unit counts = units.Of(a.unit.dimension);
    return BareIn(b, counts) * T(counts.factor / a.unit.factor);
  }
  if (!(a.unit.dimension == b.unit.dimension)) {
    throw ExpressionError(fmt::format("{} {} and {}", what, KindOf(a), KindOf(b)));
  }
  return b.figure * T(b.unit.factor / a.unit.factor);
}

/// Two figures in one unit.
template <typename T>
struct Alike {
  T a, b;
  Quantity<T> like;  ///< has that unit
};

template <typename T>
Alike<T> MadeAlike(const Quantity<T>& a, const Quantity<T>& b, const CountingUnits& units,
                   std::string_view what) {
  if (a.bare && b.bare) {
    Quantity<T> like = a;
    like.radians = a.radians || b.radians;
    return {a.figure, b.figure, like};
  }
  if (a.bare) return {InUnitOf(b, a, units, what), b.figure, b};
  return {a.figure, InUnitOf(a, b, units, what), a};
}

template <typename T>
Quantity<T> WithFigure(Quantity<T> like, T figure) {
  like.figure = figure;
  return like;
}

/// Functions of angles know their units; who converts by pi converts twice.
template <typename T>
void RequireNoConversion(const Quantity<T>& a, const Quantity<T>& b) {
  const auto angular = [](const Quantity<T>& q) { return q.unit.dimension.angle != 0; };
  if ((a.radians && angular(b)) || (b.radians && angular(a))) {
    throw ExpressionError(
        "pi meets an angle in a product; angles have their unit already (1 deg, asin(..)) and need "
        "no conversion: leave pi/180 out, or write '/rad' behind the angle to make it a number");
  }
}

template <typename T>
T Radians(const Quantity<T>& q, std::string_view function, const CountingUnits& units) {
  if (!q.bare) {
    if (q.unit.dimension == kAngle || q.unit.dimension.none()) return q.figure * T(q.unit.factor);
    throw ExpressionError(fmt::format("{} of {}; it takes an angle", function, KindOf(q)));
  }
  if (q.radians || units.angle().factor == 1) return q.figure;
  throw ExpressionError(
      fmt::format("{0} of {1:g}, a number without a unit: write {0}({1:g} deg) or {0}({1:g} rad)",
                  function, ValueOf(q.figure)));
}

template <typename T>
T Plain(const Quantity<T>& q, std::string_view what) {
  if (q.unit.dimension.none()) return q.figure;
  throw ExpressionError(fmt::format("{} is a number, not {}", what, KindOf(q)));
}

/// The argument of an inverse function.
template <typename T>
T Cosine(const Quantity<T>& q, std::string_view function) {
  const T x = Plain(q, fmt::format("what {} takes", function));
  if (std::abs(ValueOf(x)) <= 1) return x;
  throw ExpressionError(fmt::format("{} of {:g}, which is not from -1 to 1", function, ValueOf(x)));
}

template <typename T>
Quantity<T> Root(const Quantity<T>& q) {
  const double value = ValueOf(q.figure);
  if (value < 0) throw ExpressionError(fmt::format("root of {:g}, which is below zero", value));
  const double root = std::sqrt(value);
  const T figure = Applied(q.figure, root, root > 0 ? 0.5 / root : 0);
  return q.bare ? WithFigure(q, figure) : WithUnit(figure, q.unit.Power(0.5));
}

template <typename T>
Quantity<T> Trigonometric(std::string_view function, const Quantity<T>& q,
                          const CountingUnits& units) {
  const T angle = Radians(q, function, units);
  const double x = ValueOf(angle), s = std::sin(x), c = std::cos(x), t = std::tan(x);
  if (function == "sin") return WithUnit(Applied(angle, s, c), {});
  if (function == "cos") return WithUnit(Applied(angle, c, -s), {});
  return WithUnit(Applied(angle, t, 1 + t * t), {});
}

template <typename T>
Quantity<T> InverseTrigonometric(std::string_view function, const Quantity<T>& q) {
  const T x = Cosine(q, function);
  const double value = ValueOf(x), slope = 1 / std::sqrt(1 - value * value);
  if (function == "asin") return WithUnit(Applied(x, std::asin(value), slope), kRadian);
  return WithUnit(Applied(x, std::acos(value), -slope), kRadian);
}

template <typename T>
Quantity<T> OfTwo(std::string_view function, const Quantity<T>& a, const Quantity<T>& b,
                  const CountingUnits& units) {
  const Alike<T> two = MadeAlike(a, b, units, fmt::format("{} of", function));
  const bool less = ValueOf(two.a) < ValueOf(two.b);
  if (function == "min") return WithFigure(two.like, less ? two.a : two.b);
  if (function == "max") return WithFigure(two.like, less ? two.b : two.a);
  if (ValueOf(two.a) == 0 && ValueOf(two.b) == 0) {
    throw ExpressionError("atan2 of 0 and 0, which is no direction");
  }
  return WithUnit(Atan2(two.a, two.b), kRadian);
}

constexpr std::pair<std::string_view, int> kFunctions[] = {
    {"sqrt", 1}, {"sin", 1}, {"cos", 1}, {"tan", 1}, {"asin", 1},
    {"acos", 1}, {"abs", 1}, {"min", 2}, {"max", 2}, {"atan2", 2},
};

}  // namespace

CountingUnits::CountingUnits(const Unit& length, const Unit& angle, const Unit& mass,
                             const Unit& time, std::vector<Unit> named)
    : length_(length), angle_(angle), mass_(mass), time_(time), named_(std::move(named)) {}

Unit CountingUnits::Of(const Dimension& d) const {
  for (const Unit* base : {&length_, &angle_, &mass_, &time_}) {
    if (base->dimension == d) return *base;
  }
  for (const Unit& unit : named_) {
    if (unit.dimension == d) return unit;
  }
  return length_.Power(d.length) * mass_.Power(d.mass) * time_.Power(d.time) *
         angle_.Power(d.angle);
}

template <typename T>
Quantity<T> Sum(const Quantity<T>& a, const Quantity<T>& b, const CountingUnits& units) {
  const Alike<T> two = MadeAlike(a, b, units, "the sum of");
  return WithFigure(two.like, two.a + two.b);
}

template <typename T>
Quantity<T> Product(const Quantity<T>& a, const Quantity<T>& b) {
  if (a.bare && b.bare) return {a.figure * b.figure, {}, true, a.radians || b.radians};
  RequireNoConversion(a, b);
  return WithUnit(a.figure * b.figure, a.unit * b.unit);
}

template <typename T>
Quantity<T> Ratio(const Quantity<T>& a, const Quantity<T>& b) {
  if (ValueOf(b.figure) == 0) throw ExpressionError("division by zero");
  if (a.bare && b.bare) return {a.figure / b.figure, {}, true, a.radians || b.radians};
  RequireNoConversion(a, b);
  return WithUnit(a.figure / b.figure, a.unit / b.unit);
}

template <typename T>
Quantity<T> Power(const Quantity<T>& a, const Quantity<T>& b) {
  const T exponent = Plain(b, "an exponent");
  const double base = ValueOf(a.figure), power = ValueOf(exponent);
  if (base == 0 && power < 0) throw ExpressionError("division by zero: a power below zero of 0");
  if (base < 0 && power != std::floor(power)) {
    throw ExpressionError(
        fmt::format("{:g}^{:g} is no number: a broken power of what is below zero", base, power));
  }
  const T figure = PowerOf(a.figure, exponent);
  return a.bare ? WithFigure(a, figure) : WithUnit(figure, a.unit.Power(power));
}

int ArgumentsOf(std::string_view function) {
  const auto* const found = std::find_if(std::begin(kFunctions), std::end(kFunctions),
                                         [&](const auto& f) { return f.first == function; });
  return found == std::end(kFunctions) ? 0 : found->second;
}

template <typename T>
Quantity<T> Call(std::string_view function, const std::vector<Quantity<T>>& arguments,
                 const CountingUnits& units) {
  const Quantity<T>& first = arguments[0];
  if (arguments.size() == 2) return OfTwo(function, first, arguments[1], units);
  if (function == "sqrt") return Root(first);
  if (function == "abs")
    return ValueOf(first.figure) < 0 ? WithFigure(first, -first.figure) : first;
  if (function == "asin" || function == "acos") return InverseTrigonometric(function, first);
  return Trigonometric(function, first, units);
}

template <typename T>
T FigureIn(const Quantity<T>& value, const Unit& asked) {
  if (!value.bare && !(value.unit.dimension == asked.dimension)) {
    throw ExpressionError(
        fmt::format("{}, where {} is asked", KindOf(value), OneOf(asked.dimension)));
  }
  const T figure =
      value.bare ? BareIn(value, asked) : value.figure * T(value.unit.factor / asked.factor);
  if (!std::isfinite(ValueOf(figure))) throw ExpressionError("not finite");
  return figure;
}

// NOLINTBEGIN(bugprone-macro-parentheses): T is a type
#define VMECH_QUANTITIES(T)                                                               \
  template Quantity<T> Sum(const Quantity<T>&, const Quantity<T>&, const CountingUnits&); \
  template Quantity<T> Product(const Quantity<T>&, const Quantity<T>&);                   \
  template Quantity<T> Ratio(const Quantity<T>&, const Quantity<T>&);                     \
  template Quantity<T> Power(const Quantity<T>&, const Quantity<T>&);                     \
  template Quantity<T> Call(std::string_view, const std::vector<Quantity<T>>&,            \
                            const CountingUnits&);                                        \
  template T FigureIn(const Quantity<T>&, const Unit&);
VMECH_QUANTITIES(double)
VMECH_QUANTITIES(Dual)
#undef VMECH_QUANTITIES
// NOLINTEND(bugprone-macro-parentheses)

}  // namespace vmech
