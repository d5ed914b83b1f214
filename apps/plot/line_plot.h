#pragma once

#include <optional>
#include <string>
#include <vector>

#include "vmech/apps/html/markup.h"
#include "vmech/apps/plot/scale.h"

namespace vmech::plot {

enum class LineStyle { kSolid, kDashed, kDotted, kNone };
enum class Marker { kNone, kCircle, kSquare, kTriangle };

struct Axis {
  std::string title;
  std::string unit;  ///< shown in brackets; large or small values bring a prefix, "kN"
  ScaleType scale = ScaleType::kLinear;
  std::optional<double> min = std::nullopt;  ///< limits of the plot instead of those of the data
  std::optional<double> max = std::nullopt;
};

/// One curve. x and y have the same length; a pair that is not finite interrupts the curve.
struct Series {
  std::string name;  ///< for the legend
  std::vector<double> x, y;
  LineStyle line = LineStyle::kSolid;
  Marker marker = Marker::kNone;
  bool mark_peak = false;  ///< a dot and the value where |y| is largest
};

/// A horizontal line across the plot, such as a limit.
struct Level {
  double y = 0;
  std::string label;
};

/// A vertical line across the plot, such as a dead centre.
struct Station {
  double x = 0;
  std::string label;
};

/// A point of the plot that is marked by a dot, such as "90°" of the crank on a path.
struct Landmark {
  double x = 0, y = 0;
  std::string label;
};

/// Curves over a common axis.
struct LinePlot {
  std::string title;
  std::string description;  ///< for readers who cannot see the plot
  Axis x, y;
  std::vector<Series> series;
  std::vector<Level> levels;
  double width = 660;  ///< natural size [CSS pixels]
  double height = 290;
  std::vector<Station> stations = {};
  std::vector<Landmark> landmarks = {};
  /// A unit is as long upwards as to the right, as on a map; then both axes are linear and show
  /// more than their data where the frame asks for it.
  bool equal_scales = false;
};

/// Draws the plot (style: style.h). The same plot gives the same bytes.
/// @throws std::invalid_argument if x and y of a series differ in length.
html::Markup Draw(const LinePlot& plot);

}  // namespace vmech::plot
