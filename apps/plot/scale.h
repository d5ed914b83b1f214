#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "vmech/base/text/number_text.h"

namespace vmech::plot {

using vmech::FormatNumber;
using vmech::FormatShort;
using vmech::FormatSignificant;
using vmech::PowerOfTen;

/// How the numbers of an axis become lengths and labels.
enum class ScaleType {
  kLinear,
  kDegrees,  ///< linear, with ticks at divisors and multiples of 90
  kTurns,    ///< the same, labelled within the turn: 0, 180, 360, 180, 360 over two of them
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

/// The unit for labels divided by 10^exponent: ("N", 3) gives "kN", ("mm", -6) gives "10⁻⁶ mm".
std::string ScaledUnit(std::string_view unit, int exponent);

}  // namespace vmech::plot
