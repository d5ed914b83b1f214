#include "vmech/apps/plot/polar_plot.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "labels.h"
#include "vmech/apps/plot/scale.h"
#include "vmech/apps/plot/style.h"
#include "vmech/apps/plot/svg.h"

namespace vmech::plot {
namespace {

constexpr double kTitleBaseline = 15;
constexpr double kRow = 21;
constexpr double kMargin = 24;  // round the outer ring, for the names of the axes
constexpr int kRings = 4;       // about as many
constexpr int kSpokesPerTurn = 12;
constexpr int kLabelSpoke = 2;  // ring labels stand beside this spoke, at 60 degrees
constexpr double kFont = 12;

struct Layout {
  Scale radius;
  Point center;
  double outer = 0;  // radius of the outer ring in the drawing
  double height = 0;

  double Length(double value) const { return outer * value / radius.upper; }
  Point At(double x, double y) const { return {center.x + Length(x), center.y - Length(y)}; }
};

void CheckPlot(const PolarPlot& plot) {
  for (const VectorPath& path : plot.paths) {
    if (path.x.size() != path.y.size()) {
      throw std::invalid_argument(fmt::format("polar plot path '{}': {} x values but {} y values",
                                              path.name, path.x.size(), path.y.size()));
    }
  }
  const std::size_t points = plot.paths.empty() ? 0 : plot.paths.front().x.size();
  for (const PathMark& mark : plot.marks) {
    if (mark.index < points) continue;
    throw std::invalid_argument(fmt::format("polar plot mark '{}' at point {}, the path has {}",
                                            mark.label, mark.index, points));
  }
}

double LargestLength(const PolarPlot& plot) {
  double largest = 0;
  for (const VectorPath& path : plot.paths) {
    for (std::size_t i = 0; i < path.x.size(); ++i) {
      const double length = std::hypot(path.x[i], path.y[i]);
      if (std::isfinite(length)) largest = std::max(largest, length);
    }
  }
  return largest;
}

Layout Arrange(const PolarPlot& plot) {
  const int rows = (plot.title.empty() ? 0 : 1) + 1 + (plot.paths.size() > 1 ? 1 : 0);
  Layout layout;
  layout.radius = MakeScale(ScaleType::kLinear, 0, LargestLength(plot), kRings, true);
  layout.outer = plot.size / 2 - kMargin;
  layout.center = {plot.size / 2, rows * kRow + kMargin + layout.outer};
  layout.height = layout.center.y + layout.outer + kMargin;
  return layout;
}

void DrawRings(const PolarPlot& plot, const Layout& layout, SvgWriter* svg) {
  const double step = 2 * std::numbers::pi / kSpokesPerTurn;
  for (int i = 0; i < kSpokesPerTurn; ++i) {
    const bool axis = i % (kSpokesPerTurn / 4) == 0;
    const Point tip{layout.center.x + layout.outer * std::cos(i * step),
                    layout.center.y - layout.outer * std::sin(i * step)};
    svg->Line(axis ? "base" : "grid", layout.center, tip);
  }
  for (const Tick& tick : layout.radius.ticks) {
    if (tick.value <= 0) continue;
    const double r = layout.Length(tick.value);
    svg->Circle(tick.value == layout.radius.ticks.back().value ? "base" : "grid", layout.center, r);
  }
  svg->Text("soft", {layout.center.x + layout.outer + 6, layout.center.y + 4}, plot.x_name);
  svg->Text("soft mid", {layout.center.x, layout.center.y - layout.outer - 7}, plot.y_name);
}

void DrawRingLabels(const Layout& layout, SvgWriter* svg) {
  const double angle = 2 * std::numbers::pi * kLabelSpoke / kSpokesPerTurn;
  for (const Tick& tick : layout.radius.ticks) {
    if (tick.value <= 0) continue;
    const double r = layout.Length(tick.value);
    svg->Text("soft small halo mid",
              {layout.center.x + r * std::cos(angle), layout.center.y - r * std::sin(angle) + 4},
              tick.label);
  }
}

void DrawCaptions(const PolarPlot& plot, const Layout& layout, SvgWriter* svg) {
  double y = kTitleBaseline;
  if (!plot.title.empty()) {
    svg->Text("title", {0, y}, plot.title);
    y += kRow;
  }
  const std::string unit = ScaledUnit(plot.unit, layout.radius.exponent);
  svg->Text("soft", {0, y},
            unit.empty() ? plot.quantity : fmt::format("{} [{}]", plot.quantity, unit));
  if (plot.paths.size() < 2) return;
  double x = 0;
  y += kRow;
  for (std::size_t i = 0; i < plot.paths.size(); ++i) {
    svg->Line(fmt::format("curve s{}", i % kPaletteSize + 1), {x, y - 4}, {x + 20, y - 4});
    svg->Text("", {x + 27, y}, plot.paths[i].name);
    x += 28 + TextWidth(plot.paths[i].name, kFont) + 16;
  }
}

void DrawPath(const VectorPath& path, std::size_t index, const Layout& layout, SvgWriter* svg) {
  std::vector<Point> points;
  points.reserve(path.x.size());
  for (std::size_t i = 0; i < path.x.size(); ++i) {
    points.push_back(layout.At(path.x[i], path.y[i]));
  }
  svg->Polyline(fmt::format("curve s{}", index % kPaletteSize + 1), points);
}

void DrawMarks(const PolarPlot& plot, const Layout& layout, SvgWriter* svg) {
  LabelPlacer placer({0, layout.center.y - layout.outer - kMargin}, {plot.size, layout.height});
  for (const PathMark& mark : plot.marks) {
    const VectorPath& path = plot.paths.front();
    const Point at = layout.At(path.x[mark.index], path.y[mark.index]);
    if (!std::isfinite(at.x) || !std::isfinite(at.y)) continue;
    svg->Circle("dot f1", at, 3.6);
    placer.Place(at, mark.label, svg);
  }
}

}  // namespace

html::Markup Draw(const PolarPlot& plot) {
  CheckPlot(plot);
  const Layout layout = Arrange(plot);
  SvgWriter svg(plot.size, layout.height, plot.title, plot.description);
  DrawCaptions(plot, layout, &svg);
  DrawRings(plot, layout, &svg);
  for (std::size_t i = 0; i < plot.paths.size(); ++i) DrawPath(plot.paths[i], i, layout, &svg);
  DrawRingLabels(layout, &svg);
  DrawMarks(plot, layout, &svg);
  return std::move(svg).Finish();
}

}  // namespace vmech::plot
