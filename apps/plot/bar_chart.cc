#include "vmech/apps/plot/bar_chart.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "vmech/apps/plot/scale.h"
#include "vmech/apps/plot/svg.h"

namespace vmech::plot {
namespace {

constexpr double kTitleBaseline = 15;
constexpr double kHead = 42;  // title and quantity
constexpr double kRow = 22;
constexpr double kThick = 12;  // of a bar
constexpr double kFont = 12;
constexpr double kGap = 8;      // between a bar and its texts
constexpr double kFigure = 56;  // room for a value

struct Layout {
  double labels = 0;    // width of the widest label
  double zero = 0;      // where bars begin
  double per_unit = 0;  // drawing units
  double height = 0;
};

Layout Arrange(const BarChart& chart) {
  double low = 0, high = 0;
  Layout layout;
  for (const Bar& bar : chart.bars) {
    layout.labels = std::max(layout.labels, TextWidth(bar.label, kFont));
    if (!std::isfinite(bar.value)) continue;
    low = std::min(low, bar.value);
    high = std::max(high, bar.value);
  }
  const double left = layout.labels + kGap + (low < 0 ? kFigure : 0);
  const double room = chart.width - left - kFigure;
  layout.per_unit = high > low ? room / (high - low) : 0;
  layout.zero = left - low * layout.per_unit;
  layout.height = kHead + kRow * static_cast<double>(chart.bars.size());
  return layout;
}

void DrawBar(const Bar& bar, double middle, const Layout& layout, SvgWriter* svg) {
  svg->Text("", {0, middle + 4}, bar.label);
  if (!std::isfinite(bar.value)) return;
  const double tip = layout.zero + bar.value * layout.per_unit;
  const std::array<Point, 4> corners{{{layout.zero, middle - kThick / 2},
                                      {tip, middle - kThick / 2},
                                      {tip, middle + kThick / 2},
                                      {layout.zero, middle + kThick / 2}}};
  svg->Polygon(bar.value < 0 ? "f2" : "f1", corners);
  const std::string value = fmt::format("{:+.3g}", bar.value);
  if (bar.value < 0) {
    svg->Text("soft end", {tip - kGap / 2, middle + 4}, value);
  } else {
    svg->Text("soft", {tip + kGap / 2, middle + 4}, value);
  }
}

}  // namespace

html::Markup Draw(const BarChart& chart) {
  const Layout layout = Arrange(chart);
  SvgWriter svg(chart.width, layout.height, chart.title, chart.description);
  svg.Text("title", {0, kTitleBaseline}, chart.title);
  svg.Text("soft", {0, kTitleBaseline + 18}, chart.quantity);
  double middle = kHead + kRow / 2;
  for (const Bar& bar : chart.bars) {
    DrawBar(bar, middle, layout, &svg);
    middle += kRow;
  }
  svg.Line("base", {layout.zero, kHead}, {layout.zero, layout.height});
  return std::move(svg).Finish();
}

}  // namespace vmech::plot
