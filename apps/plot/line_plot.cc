#include "vmech/apps/plot/line_plot.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

#include "labels.h"
#include "vmech/apps/plot/decimate.h"
#include "vmech/apps/plot/style.h"
#include "vmech/apps/plot/svg.h"

namespace vmech::plot {
namespace {

constexpr double kFont = 12;  // of tick labels and titles (style.cc)
constexpr double kPixelsPerTickX = 85;
constexpr double kPixelsPerTickY = 42;
constexpr double kTitleBaseline = 15;
constexpr double kRow = 21;  // height of the title, legend and caption rows

/// The frame of the curves and how data come into it.
struct Layout {
  Scale x, y;
  double left = 0, right = 0, top = 0, bottom = 0;
  double caption_baseline = 0;
  std::vector<Point> legend;  ///< where the entry of each series begins; empty without a legend

  Point At(double data_x, double data_y) const {
    return {left + x.Fraction(data_x) * (right - left),
            bottom - y.Fraction(data_y) * (bottom - top)};
  }
};

Scale ScaleOf(const Axis& axis, const std::vector<const std::vector<double>*>& data, int target,
              bool rounded) {
  double min = std::numeric_limits<double>::infinity(), max = -min;
  for (const std::vector<double>* values : data) {
    for (const double value : *values) {
      if (!std::isfinite(value) || (axis.scale == ScaleType::kLog && value <= 0)) continue;
      min = std::min(min, value);
      max = std::max(max, value);
    }
  }
  const bool free = !axis.min && !axis.max;
  return MakeScale(axis.scale, axis.min.value_or(min), axis.max.value_or(max), target,
                   rounded && free);
}

std::string Caption(const Axis& axis, const Scale& scale) {
  const std::string unit = ScaledUnit(axis.unit, scale.exponent);
  return unit.empty() ? axis.title : fmt::format("{} [{}]", axis.title, unit);
}

double EntryWidth(const Series& series) {
  return 28 + TextWidth(series.name, kFont) + 16;
}

/// Places the legend beside the caption of the y axis, or in rows of its own above it. Returns the
/// height of these.
double PlaceLegend(const LinePlot& plot, double caption, Layout* layout) {
  if (plot.series.size() < 2) return 0;
  double width = -16;
  for (const Series& series : plot.series) width += EntryWidth(series);
  const bool beside = caption + 24 <= layout->right - width;
  Point at{beside ? layout->right - width : 0, layout->caption_baseline};
  for (const Series& series : plot.series) {
    if (!beside && at.x > 0 && at.x + EntryWidth(series) - 16 > plot.width) {
      at = {0, at.y + kRow};
    }
    layout->legend.push_back(at);
    at.x += EntryWidth(series);
  }
  return beside ? 0 : at.y + kRow - layout->caption_baseline;
}

/// Room for the labels of the y axis, left of the frame.
void MakeRoomForTicks(Layout* layout) {
  layout->left = 0;
  for (const Tick& tick : layout->y.ticks) {
    layout->left = std::max(layout->left, TextWidth(tick.label, kFont) + 9);
  }
}

int TicksFor(double length, double pixels_per_tick) {
  return static_cast<int>(std::max(2.0, length / pixels_per_tick));
}

/// A scale with the same middle on which `length` drawing units show `range`.
Scale Recentred(const Scale& scale, double range, double length, double pixels_per_tick) {
  const double middle = 0.5 * (scale.lower + scale.upper);
  return MakeScale(ScaleType::kLinear, middle - 0.5 * range, middle + 0.5 * range,
                   TicksFor(length, pixels_per_tick), false);
}

/// The same length for a unit on both axes, with some room around the data.
void EqualiseScales(Layout* layout) {
  constexpr double kRoom = 1.1;
  const Scale x = layout->x, y = layout->y;
  for (int pass = 0; pass < 2; ++pass) {  // the second with the room that the new labels take
    const double width = layout->right - layout->left, height = layout->bottom - layout->top;
    const double unit = kRoom * std::max((x.upper - x.lower) / width, (y.upper - y.lower) / height);
    layout->x = Recentred(x, unit * width, width, kPixelsPerTickX);
    layout->y = Recentred(y, unit * height, height, kPixelsPerTickY);
    MakeRoomForTicks(layout);
  }
  const double width = layout->right - layout->left, height = layout->bottom - layout->top;
  layout->x =
      Recentred(x, (layout->y.upper - layout->y.lower) / height * width, width, kPixelsPerTickX);
}

Layout Arrange(const LinePlot& plot) {
  std::vector<const std::vector<double>*> xs, ys;
  for (const Series& series : plot.series) xs.push_back(&series.x), ys.push_back(&series.y);
  std::vector<double> levels;
  for (const Level& level : plot.levels) levels.push_back(level.y);
  ys.push_back(&levels);

  Layout layout;
  layout.right = plot.width - 12;
  layout.bottom = plot.height - 42;
  layout.caption_baseline = kTitleBaseline + (plot.title.empty() ? 0 : kRow);
  const int y_ticks = static_cast<int>(std::max(2.0, (layout.bottom - 50) / kPixelsPerTickY));
  layout.y = ScaleOf(plot.y, ys, y_ticks, !plot.equal_scales);
  MakeRoomForTicks(&layout);
  layout.x = ScaleOf(plot.x, xs, TicksFor(layout.right - layout.left, kPixelsPerTickX), false);

  layout.caption_baseline +=
      PlaceLegend(plot, TextWidth(Caption(plot.y, layout.y), kFont), &layout);
  layout.top = layout.caption_baseline + 14;
  if (plot.equal_scales) EqualiseScales(&layout);
  return layout;
}

std::string Css(std::string_view role, char fill_or_stroke, std::size_t series) {
  return fmt::format("{} {}{}", role, fill_or_stroke, series % kPaletteSize + 1);
}

std::string CurveCss(const Series& series, std::size_t index) {
  std::string css = Css("curve", 's', index);
  if (series.line == LineStyle::kDashed) css += " dashed";
  if (series.line == LineStyle::kDotted) css += " dotted";
  return css;
}

void DrawMarker(const Series& series, std::size_t index, Point at, SvgWriter* svg) {
  const std::string css = Css("hollow", 's', index);
  if (series.marker == Marker::kCircle) return svg->Circle(css, at, 3.4);
  std::vector<Point> corners = {
      {at.x - 3, at.y - 3}, {at.x + 3, at.y - 3}, {at.x + 3, at.y + 3}, {at.x - 3, at.y + 3}};
  if (series.marker == Marker::kTriangle) {
    corners = {{at.x, at.y - 4.2}, {at.x + 4, at.y + 2.8}, {at.x - 4, at.y + 2.8}};
  }
  svg->Polygon(css, corners);
}

void DrawLegend(const LinePlot& plot, const Layout& layout, SvgWriter* svg) {
  for (std::size_t i = 0; i < layout.legend.size(); ++i) {
    const Series& series = plot.series[i];
    const double x = layout.legend[i].x, y = layout.legend[i].y - 4;
    if (series.line != LineStyle::kNone) svg->Line(CurveCss(series, i), {x, y}, {x + 20, y});
    if (series.marker != Marker::kNone) DrawMarker(series, i, {x + 10, y}, svg);
    svg->Text("", {x + 27, layout.legend[i].y}, series.name);
  }
}

void DrawFrame(const LinePlot& plot, const Layout& layout, SvgWriter* svg) {
  if (!plot.title.empty()) svg->Text("title", {0, kTitleBaseline}, plot.title);
  svg->Text("soft", {0, layout.caption_baseline}, Caption(plot.y, layout.y));
  for (const Tick& tick : layout.y.ticks) {
    const double y = layout.At(layout.x.lower, tick.value).y;
    const bool zero = tick.value == 0 || tick.value == layout.y.lower;
    svg->Line(zero ? "base" : "grid", {layout.left, y}, {layout.right, y});
    svg->Text("soft end", {layout.left - 7, y + 4}, tick.label);
  }
  for (const Tick& tick : layout.x.ticks) {
    const double x = layout.At(tick.value, layout.y.lower).x;
    svg->Line("base", {x, layout.bottom}, {x, layout.bottom + 4});
    const bool at_edge = x + TextWidth(tick.label, kFont) / 2 > plot.width;
    svg->Text(at_edge ? "soft end" : "soft mid", {at_edge ? plot.width : x, layout.bottom + 18},
              tick.label);
  }
  svg->Text("soft mid", {(layout.left + layout.right) / 2, layout.bottom + 37},
            Caption(plot.x, layout.x));
}

void DrawSeries(const Series& series, std::size_t index, const Layout& layout, SvgWriter* svg) {
  std::vector<Point> points;
  points.reserve(series.x.size());
  for (std::size_t i = 0; i < series.x.size(); ++i) {
    points.push_back(layout.At(series.x[i], series.y[i]));
  }
  if (series.marker != Marker::kNone) {
    for (const Point& p : points) {
      if (std::isfinite(p.x) && std::isfinite(p.y)) DrawMarker(series, index, p, svg);
    }
  }
  if (series.line != LineStyle::kNone) {
    svg->Polyline(CurveCss(series, index), Decimate(std::move(points)));
  }
}

/// Index of the largest |y|; -1 if none is finite.
std::ptrdiff_t PeakOf(const Series& series) {
  std::ptrdiff_t peak = -1;
  for (std::size_t i = 0; i < series.y.size(); ++i) {
    if (!std::isfinite(series.y[i]) || !std::isfinite(series.x[i])) continue;
    if (peak < 0 || std::abs(series.y[i]) > std::abs(series.y[static_cast<std::size_t>(peak)])) {
      peak = static_cast<std::ptrdiff_t>(i);
    }
  }
  return peak;
}

/// The value in the unit of the axis, to about a thousandth of the axis' range.
std::string PeakLabel(double value, const Scale& scale) {
  if (scale.type == ScaleType::kLog) return FormatSignificant(value, 3);
  const double unit = std::pow(10.0, scale.exponent);
  const double magnitude = std::floor(std::log10((scale.upper - scale.lower) / unit));
  return FormatNumber(value / unit, std::max(0, 2 - static_cast<int>(magnitude)));
}

void DrawPeaks(const LinePlot& plot, const Layout& layout, SvgWriter* svg) {
  LabelPlacer placer({layout.left, layout.top - 14}, {plot.width, layout.bottom});
  for (std::size_t s = 0; s < plot.series.size(); ++s) {
    const Series& series = plot.series[s];
    const std::ptrdiff_t peak = series.mark_peak ? PeakOf(series) : -1;
    if (peak < 0) continue;
    const auto i = static_cast<std::size_t>(peak);
    const Point at = layout.At(series.x[i], series.y[i]);
    svg->Circle(Css("dot", 'f', s), at, 4);
    placer.Place(at, PeakLabel(series.y[i], layout.y), svg);
  }
}

void DrawLandmarks(const LinePlot& plot, const Layout& layout, SvgWriter* svg) {
  LabelPlacer placer({layout.left, layout.top - 14}, {plot.width, layout.bottom});
  for (const Landmark& mark : plot.landmarks) {
    const Point at = layout.At(mark.x, mark.y);
    if (!std::isfinite(at.x) || !std::isfinite(at.y)) continue;
    svg->Circle("dot f1", at, 3.6);
    placer.Place(at, mark.label, svg);
  }
}

void DrawLevels(const LinePlot& plot, const Layout& layout, SvgWriter* svg) {
  for (const Level& level : plot.levels) {
    const double y = layout.At(layout.x.lower, level.y).y;
    if (!std::isfinite(y)) continue;
    svg->Line("level", {layout.left, y}, {layout.right, y});
    svg->Text("soft small halo", {layout.left + 6, y - 5}, level.label);
  }
}

void DrawStations(const LinePlot& plot, const Layout& layout, SvgWriter* svg) {
  for (const Station& station : plot.stations) {
    const double x = layout.At(station.x, layout.y.lower).x;
    if (!(x >= layout.left && x <= layout.right)) continue;
    svg->Line("level", {x, layout.top}, {x, layout.bottom});
    const bool at_edge = x + 6 + TextWidth(station.label, kFont) > plot.width;
    svg->Text(at_edge ? "soft small halo end" : "soft small halo",
              {at_edge ? x - 5 : x + 5, layout.bottom - 6}, station.label);
  }
}

}  // namespace

html::Markup Draw(const LinePlot& plot) {
  for (const Series& series : plot.series) {
    if (series.x.size() != series.y.size()) {
      throw std::invalid_argument(fmt::format("plot series '{}': {} x values but {} y values",
                                              series.name, series.x.size(), series.y.size()));
    }
  }
  const Layout layout = Arrange(plot);
  SvgWriter svg(plot.width, plot.height, plot.title, plot.description);
  DrawFrame(plot, layout, &svg);
  DrawLegend(plot, layout, &svg);
  const bool clipped = plot.x.min || plot.x.max || plot.y.min || plot.y.max;
  if (clipped) {
    svg.BeginClip({layout.left, layout.top}, layout.right - layout.left,
                  layout.bottom - layout.top);
  }
  for (std::size_t i = 0; i < plot.series.size(); ++i) {
    DrawSeries(plot.series[i], i, layout, &svg);
  }
  if (clipped) svg.EndClip();
  DrawLevels(plot, layout, &svg);
  DrawStations(plot, layout, &svg);
  if (!clipped) DrawPeaks(plot, layout, &svg);
  DrawLandmarks(plot, layout, &svg);
  return std::move(svg).Finish();
}

}  // namespace vmech::plot
