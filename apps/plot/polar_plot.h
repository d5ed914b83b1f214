#pragma once

#include <string>
#include <vector>

#include "vmech/apps/html/markup.h"

namespace vmech::plot {

/// The path of a vector's tip, seen from its foot.
struct VectorPath {
  std::string name;          ///< for the legend
  std::vector<double> x, y;  ///< of the same length; a pair that is not finite interrupts the path
};

/// A point of the first path that is marked, such as "90°" of the crank.
struct PathMark {
  std::size_t index = 0;
  std::string label;
};

/// The polar load diagram of a joint: the tip of its radial load over the cycle on rings of equal
/// load. The x axis points to the right, the y axis up.
struct PolarPlot {
  std::string title;
  std::string description;  ///< for readers who cannot see the plot
  std::string quantity;     ///< "radial load"
  std::string unit;
  std::string x_name = "x", y_name = "y";
  std::vector<VectorPath> paths;
  std::vector<PathMark> marks;
  double size = 300;  ///< width; the height follows from the rows of text [CSS pixels]
};

/// Draws the plot (style: style.h). The same plot gives the same bytes.
/// @throws std::invalid_argument if x and y of a path differ in length or a mark is outside.
html::Markup Draw(const PolarPlot& plot);

}  // namespace vmech::plot
