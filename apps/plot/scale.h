#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace vmech::plot {

/// How the numbers of an axis become lengths and labels.
enum class ScaleType {
  kLinear,
  kDegrees,  ///< linear, with ticks at divisors and multiples of 90
  kLog,      ///< base ten; values that are not positive are left out
};

struct Tick {
  double value = 0;
  std::string label;
};

/// The visible range of an axis and its ticks.
struct Scale {
  ScaleType type = ScaleType::kLinear;
  double lower = 0;
  double upper = 1;
  int exponent = 0;  ///< the labels show value / 10^exponent; a multiple of 3
  std::vector<Tick> ticks;

  /// 0 at `lower`, 1 at `upper`; NaN for a value that the axis cannot show.
  double Fraction(double value) const;
};

/// A range for data in [min, max] with about `target` ticks at 1, 2 or 5 times a power of ten. With
/// `rounded` the range is widened to whole ticks, and to zero if zero is near; otherwise it is
/// [min, max]. A range that is empty or not finite is replaced by one that can be drawn.
Scale MakeScale(ScaleType type, double min, double max, int target, bool rounded);

/// "12 000", "−0.25": true minus, thin spaces between thousands from five digits on.
std::string FormatNumber(double value, int decimals);

/// The value to `digits` significant digits, written as FormatNumber does; scientific ("1.2×10⁻⁹")
/// where that needs many zeros. "–" for a value that is not finite.
std::string FormatSignificant(double value, int digits);

/// FormatSignificant without zeros at the end: "15", "0.4".
std::string FormatShort(double value, int digits);

/// The unit for labels divided by 10^exponent: ("N", 3) gives "kN", ("mm", -6) gives "10⁻⁶ mm".
std::string ScaledUnit(std::string_view unit, int exponent);

/// "10⁻³".
std::string PowerOfTen(int exponent);

}  // namespace vmech::plot
