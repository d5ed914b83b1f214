#pragma once

#include <string>
#include <vector>

#include "vmech/apps/html/markup.h"

namespace vmech::plot {

struct Bar {
  std::string label;
  double value = 0;
};

/// Bars to the right and left of zero, one below the other, each with its label and its value.
struct BarChart {
  std::string title;
  std::string description;  ///< for readers who cannot see the chart
  std::string quantity;     ///< "percent by a percent"
  std::vector<Bar> bars;
  double width = 480;  ///< natural size [CSS pixels]; the height follows from the bars
};

/// Draws the chart (style: style.h). The same chart gives the same bytes. A value that is not
/// finite has no bar.
html::Markup Draw(const BarChart& chart);

}  // namespace vmech::plot
