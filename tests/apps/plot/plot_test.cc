#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <regex>
#include <stdexcept>

#include "vmech/apps/plot/decimate.h"
#include "vmech/apps/plot/line_plot.h"
#include "vmech/apps/plot/polar_plot.h"
#include "vmech/apps/plot/style.h"

namespace vmech::plot {
namespace {

LinePlot SinePlot(int points) {
  Series series{"load", {}, {}};
  for (int i = 0; i < points; ++i) {
    series.x.push_back(360.0 * i / (points - 1));
    series.y.push_back(100 * std::sin(2 * std::numbers::pi * i / (points - 1)));
  }
  LinePlot plot;
  plot.title = "Load";
  plot.x = {"angle", "°", ScaleType::kDegrees, {}, {}};
  plot.y = {"force", "N", ScaleType::kLinear, {}, {}};
  plot.series = {series};
  return plot;
}

int Count(const std::string& text, const std::string& pattern) {
  int count = 0;
  for (auto at = text.find(pattern); at != std::string::npos; at = text.find(pattern, at + 1)) {
    ++count;
  }
  return count;
}

TEST(LinePlot, SaysTitleAxesAndUnits) {
  const std::string svg = Draw(SinePlot(50)).html();
  for (const char* text :
       {"<title>Load</title>", ">force [N]<", ">angle [°]<", ">270<", ">−100<"}) {
    EXPECT_NE(svg.find(text), std::string::npos) << text;
  }
}

TEST(LinePlot, PeakIsMarkedWithItsValue) {
  LinePlot plot = SinePlot(361);
  plot.series[0].y[200] = -123.4;
  plot.series[0].mark_peak = true;
  EXPECT_NE(Draw(plot).html().find(">−123<"), std::string::npos);
}

TEST(LinePlot, LegendAppearsWithTheSecondSeriesAndEscapesItsName) {
  LinePlot plot = SinePlot(10);
  EXPECT_EQ(Draw(plot).html().find(">load<"), std::string::npos);
  plot.series.push_back(plot.series[0]);
  plot.series[1].name = "</svg><script>";
  const std::string svg = Draw(plot).html();
  EXPECT_NE(svg.find(">load<"), std::string::npos);
  EXPECT_NE(svg.find(">&lt;/svg&gt;&lt;script&gt;<"), std::string::npos);
}

TEST(LinePlot, ValuesThatAreNotFiniteInterruptTheCurve) {
  LinePlot plot = SinePlot(9);
  plot.series[0].y[4] = std::nan("");
  plot.series[0].y[6] = INFINITY;
  const std::string svg = Draw(plot).html();
  const std::string path = svg.substr(svg.find(" d=\""));
  EXPECT_EQ(Count(path.substr(0, path.find("/>")), "M"), 3);
  EXPECT_EQ(svg.find("nan"), std::string::npos);
  EXPECT_EQ(svg.find("inf"), std::string::npos);
}

TEST(LinePlot, EmptyPlotIsDrawn) {
  LinePlot plot;
  EXPECT_NE(Draw(plot).html().find("</svg>"), std::string::npos);
  plot.series.push_back({"empty", {}, {}});
  plot.series[0].mark_peak = true;
  EXPECT_NE(Draw(plot).html().find("</svg>"), std::string::npos);
}

TEST(LinePlot, SamePlotGivesSameBytes) {
  EXPECT_EQ(Draw(SinePlot(720)).html(), Draw(SinePlot(720)).html());
}

TEST(LinePlot, LongSeriesGrowsNoLargerThanThePixelsNeed) {
  EXPECT_LT(Draw(SinePlot(200000)).html().size(), 60000u);
}

TEST(LinePlot, SeriesOfUnequalLengthIsRefused) {
  LinePlot plot = SinePlot(9);
  plot.series[0].y.pop_back();
  EXPECT_THROW(Draw(plot), std::invalid_argument);
}

TEST(Decimate, KeepsEveryPeak) {
  std::vector<Point> points;
  for (int i = 0; i < 10000; ++i) points.push_back({i * 0.01, 0.001 * (i % 7)});
  points[1234].y = 50;
  points[7777].y = -50;
  const std::vector<Point> kept = Decimate(points);
  EXPECT_LE(kept.size(), 4u * 101u);
  EXPECT_EQ(kept.front().x, points.front().x);
  EXPECT_EQ(kept.back().x, points.back().x);
  for (const double peak : {50.0, -50.0}) {
    EXPECT_TRUE(std::any_of(kept.begin(), kept.end(), [=](Point p) { return p.y == peak; }));
  }
}

TEST(Decimate, OfACurveThatTurnsBackKeepsWhatCanBeSeen) {
  const std::vector<Point> loop = {{0, 0}, {0.1, 1}, {0.2, 0}, {0.15, -1}, {0.12, 0}};
  EXPECT_EQ(Decimate(loop).size(), loop.size());
  std::vector<Point> circle;
  for (int i = 0; i <= 5000; ++i) {
    circle.push_back({50 * std::cos(i * 2e-3), 50 * std::sin(i * 2e-3)});
  }
  const std::vector<Point> kept = Decimate(circle);
  EXPECT_LT(kept.size(), 1100u);  // ten radians of 50 units, a point every half
  for (std::size_t i = 1; i < kept.size(); ++i) {
    EXPECT_LT(std::hypot(kept[i].x - kept[i - 1].x, kept[i].y - kept[i - 1].y), 0.61);
  }
  EXPECT_EQ(kept.back().x, circle.back().x);
}

/// Numbers of a path's `d`, as points from moves and lines that go on from each other.
std::vector<Point> PointsOf(const std::string& svg) {
  const std::string path = svg.substr(svg.find(" d=\"") + 4);
  const std::regex step(R"([Ml](-?[\d.]+) ?(-?[\d.]+))");
  std::vector<Point> points;
  Point at;
  for (std::sregex_iterator it(path.begin(), path.end(), step), end; it != end; ++it) {
    at = {at.x + std::stod((*it)[1]), at.y + std::stod((*it)[2])};
    points.push_back(at);
  }
  return points;
}

TEST(LinePlot, EqualScalesDrawACircleRound) {
  LinePlot plot;
  plot.equal_scales = true;
  Series circle;
  for (int i = 0; i <= 360; ++i) {
    circle.x.push_back(1000 + 3 * std::cos(i * std::numbers::pi / 180));
    circle.y.push_back(-20 + 3 * std::sin(i * std::numbers::pi / 180));
  }
  plot.series = {circle};
  const std::vector<Point> points = PointsOf(Draw(plot).html());
  ASSERT_GT(points.size(), 100u);
  Point least = points[0], greatest = least;
  for (const Point& p : points) {
    least = {std::min(least.x, p.x), std::min(least.y, p.y)};
    greatest = {std::max(greatest.x, p.x), std::max(greatest.y, p.y)};
  }
  EXPECT_NEAR(greatest.x - least.x, greatest.y - least.y, 0.1);
  EXPECT_GT(greatest.y - least.y, 150);
}

TEST(SvgWriter, CoordinatesAddUpWithoutDrift) {
  SvgWriter writer(10, 10, "", "");
  std::vector<Point> points;
  for (int i = 0; i <= 1000; ++i) points.push_back({i * 0.0137, 5 - i * 0.0049});
  writer.Polyline("", points);
  const std::string svg = std::move(writer).Finish().html();
  const std::string path = svg.substr(svg.find(" d=\"") + 4);
  double x = 0, y = 0;
  const std::regex step(R"([Ml](-?[\d.]+) ?(-?[\d.]+))");
  for (std::sregex_iterator it(path.begin(), path.end(), step), end; it != end; ++it) {
    x += std::stod((*it)[1]);
    y += std::stod((*it)[2]);
  }
  constexpr double kHundredth = 0.005 + 1e-9;  // coordinates are kept to a hundredth
  EXPECT_NEAR(x, 13.7, kHundredth);
  EXPECT_NEAR(y, 0.1, kHundredth);
}

PolarPlot CirclePlot() {
  PolarPlot plot;
  plot.quantity = "radial load";
  plot.unit = "N";
  plot.paths = {{"load", {1900, 0, -1900, 0}, {0, 1900, 0, -1900}}};
  return plot;
}

TEST(PolarPlot, RingsReachBeyondTheLargestLoad) {
  const std::string svg = Draw(CirclePlot()).html();
  EXPECT_NE(svg.find(">radial load [N]<"), std::string::npos);
  EXPECT_NE(svg.find(">2000<"), std::string::npos);
}

TEST(PolarPlot, YPointsUpAndXToTheRight) {
  PolarPlot plot = CirclePlot();
  plot.paths[0] = {"load", {0, 2000, 0}, {0, 0, 2000}};
  plot.size = 248;  // outer ring of radius 100 about (124, 145)
  EXPECT_NE(Draw(plot).html().find("d=\"M124 145l100 0l-100-100\""), std::string::npos);
}

TEST(PolarPlot, MarksCarryTheirLabels) {
  PolarPlot plot = CirclePlot();
  plot.marks = {{1, "90°"}};
  EXPECT_NE(Draw(plot).html().find(">90°<"), std::string::npos);
  plot.marks = {{4, "outside"}};
  EXPECT_THROW(Draw(plot), std::invalid_argument);
}

TEST(StandaloneSvg, CarriesItsStyle) {
  const std::string svg = StandaloneSvg(Draw(CirclePlot()));
  EXPECT_EQ(svg.rfind("<svg xmlns=", 0), 0u);
  EXPECT_NE(svg.find(std::string(PlotStyleSheet())), std::string::npos);
}

}  // namespace
}  // namespace vmech::plot
