#include "vmech/apps/plot/scale.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace vmech::plot {
namespace {

constexpr double kTickSlack = 1e-9;  // of a tick step: what rounding may shift a tick by

constexpr double kSnap = 0.015;  // of the range: how near an end of it is to a tick

/// The smallest of 1, 2, 5, 10 times a power of ten that is not below `raw`.
double NiceStep(double raw) {
  const double decade = std::pow(10.0, std::floor(std::log10(raw)));
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (factor * decade >= raw * (1 - kTickSlack)) return factor * decade;
  }
  return 10 * decade;
}

double NiceAngleStep(double raw) {
  for (const double step : {5.0, 10.0, 15.0, 30.0, 45.0, 90.0, 180.0, 360.0, 720.0}) {
    if (step >= raw) return step;
  }
  return 360 * NiceStep(raw / 360);
}

bool IsAngle(ScaleType type) {
  return type == ScaleType::kDegrees || type == ScaleType::kTurns;
}

/// The angle above 0, up to 360: where a turn ends it is 360, where all begins it is 0.
double WithinTurn(double angle) {
  return angle == 0 ? 0 : angle - 360 * (std::ceil(angle / 360) - 1);
}

int ExponentFor(double magnitude) {
  if (magnitude == 0 || (magnitude >= 0.01 && magnitude < 1e5)) return 0;
  return 3 * static_cast<int>(std::floor(std::log10(magnitude) / 3 + kTickSlack));
}

int DecimalsFor(double step) {
  return std::max(0, -static_cast<int>(std::floor(std::log10(step) + kTickSlack)));
}

/// Makes [min, max] a range that can be drawn.
void Repair(ScaleType type, double* min, double* max) {
  if (!std::isfinite(*min) || !std::isfinite(*max) || *min > *max) *min = 0, *max = 1;
  if (type == ScaleType::kLog) {
    if (*max <= 0) *max = 1;
    if (*min <= 0) *min = *max / 10;
    if (*min == *max) *max *= 10;
    return;
  }
  const double size = std::max(std::abs(*min), std::abs(*max));
  if (*max - *min > 1e-12 * size) return;  // a narrower range is rounding, drawn as a straight line
  if (size < std::numeric_limits<double>::min()) {
    *min = 0, *max = 1;
  } else {
    *min = std::min(0.0, *min), *max = std::max(0.0, *max);
  }
}

/// Moves the ends of the range to the next tick outside where it is near: 0 .. 719 becomes 0 ..
/// 720.
void SnapToTicks(double step, Scale* scale) {
  const double near = kSnap * (scale->upper - scale->lower);
  const double below = step * std::floor(scale->lower / step + kTickSlack);
  const double above = step * std::ceil(scale->upper / step - kTickSlack);
  if (scale->lower - below <= near) scale->lower = below;
  if (above - scale->upper <= near) scale->upper = above;
}

void AddLinearTicks(double step, bool rounded, Scale* scale) {
  SnapToTicks(step, scale);
  if (rounded) {
    scale->lower = step * std::floor(scale->lower / step + kTickSlack);
    scale->upper = step * std::ceil(scale->upper / step - kTickSlack);
  }
  scale->exponent = ExponentFor(std::max(std::abs(scale->lower), std::abs(scale->upper)));
  const double unit = std::pow(10.0, scale->exponent);
  const int decimals = IsAngle(scale->type) ? 0 : DecimalsFor(step / unit);
  const bool turns = scale->type == ScaleType::kTurns;
  const double first = std::ceil(scale->lower / step - kTickSlack);
  const double last = std::floor(scale->upper / step + kTickSlack);
  for (double i = first; i <= last; ++i) {
    const double shown = turns ? WithinTurn(i * step) : i * step / unit;
    scale->ticks.push_back({i * step, FormatNumber(shown, decimals)});
  }
}

void AddLogTicks(int target, bool rounded, Scale* scale) {
  if (rounded) {
    scale->lower = std::pow(10.0, std::floor(std::log10(scale->lower) + kTickSlack));
    scale->upper = std::pow(10.0, std::ceil(std::log10(scale->upper) - kTickSlack));
    if (scale->upper <= scale->lower) scale->upper = 10 * scale->lower;
  }
  const int first = static_cast<int>(std::ceil(std::log10(scale->lower) - kTickSlack));
  const int last = static_cast<int>(std::floor(std::log10(scale->upper) + kTickSlack));
  const int stride = std::max(1, (last - first) / std::max(1, 2 * target) + 1);
  const bool sparse = last - first < 2;         // within two decades 2 and 5 are labelled too
  const bool plain = first >= -2 && last <= 3;  // all as 0.01, 10 or all as powers
  for (int i = sparse ? first - 1 : first; i <= last; i += stride) {
    for (const int factor : {1, 2, 5}) {
      const double value = factor * std::pow(10.0, i);
      const bool inside =
          value >= scale->lower * (1 - kTickSlack) && value <= scale->upper * (1 + kTickSlack);
      if (!inside || (factor > 1 && !sparse)) continue;
      scale->ticks.push_back(
          {value, plain ? FormatNumber(value, std::max(0, -i))
                        : (factor == 1 ? "" : fmt::format("{}×", factor)) + PowerOfTen(i)});
    }
  }
}

}  // namespace

double Scale::Fraction(double value) const {
  if (type != ScaleType::kLog) return (value - lower) / (upper - lower);
  if (!(value > 0)) return std::numeric_limits<double>::quiet_NaN();
  return std::log(value / lower) / std::log(upper / lower);
}

Scale MakeScale(ScaleType type, double min, double max, int target, bool rounded) {
  Repair(type, &min, &max);
  const double span = max - min;
  if (type == ScaleType::kLinear && rounded) {  // show zero where that costs little
    if (min > 0 && min < span) min = 0;
    if (max < 0 && -max < span) max = 0;
  }
  Scale scale{type, min, max, 0, {}};
  if (type == ScaleType::kLog) {
    AddLogTicks(target, rounded, &scale);
  } else {
    const double raw = (max - min) / target;
    AddLinearTicks(IsAngle(type) ? NiceAngleStep(raw) : NiceStep(raw), rounded, &scale);
  }
  return scale;
}

std::string ScaledUnit(std::string_view unit, int exponent) {
  constexpr std::array<std::string_view, 9> kPrefixed = {"N", "N m", "W",   "J",   "Pa",
                                                         "s", "m",   "m/s", "m/s²"};
  constexpr std::array<std::string_view, 8> kPrefixes = {"p", "n", "µ", "m", "", "k", "M", "G"};
  if (exponent == 0) return std::string(unit);
  const bool prefixed = std::find(kPrefixed.begin(), kPrefixed.end(), unit) != kPrefixed.end();
  if (prefixed && exponent >= -12 && exponent <= 9) {
    return fmt::format("{}{}", kPrefixes[exponent / 3 + 4], unit);
  }
  return unit.empty() ? PowerOfTen(exponent) : PowerOfTen(exponent) + " " + std::string(unit);
}

}  // namespace vmech::plot
