#pragma once

#include <span>
#include <string>
#include <string_view>

#include "vmech/apps/html/markup.h"

namespace vmech::plot {

/// A point of the drawing, in its units (CSS pixels at natural size): x to the right, y down.
struct Point {
  double x = 0;
  double y = 0;
};

/// Writes one SVG drawing as a string. Coordinates are kept to a hundredth of a unit in integer
/// arithmetic: fast, compact, and the same bytes on every machine. Appearance comes from CSS
/// classes (style.h) alone.
class SvgWriter {
 public:
  /// `title` and `description` are what a screen reader says.
  SvgWriter(double width, double height, std::string_view title, std::string_view description);

  void Line(std::string_view css, Point from, Point to);
  void Circle(std::string_view css, Point center, double radius);
  /// Text with its baseline at `at`; classes `mid` and `end` centre and right-align it.
  void Text(std::string_view css, Point at, std::string_view text);
  /// A line through the points. Where a point is not finite the line is interrupted.
  void Polyline(std::string_view css, std::span<const Point> points);
  /// A filled area with the points as its corners.
  void Polygon(std::string_view css, std::span<const Point> points);
  /// Everything until EndClip is drawn only inside the rectangle; coordinates stay as they are.
  void BeginClip(Point corner, double width, double height);
  void EndClip();

  html::Markup Finish() &&;

 private:
  void Open(std::string_view element, std::string_view css);
  void Number(std::string_view attribute, double value);
  void PathData(std::span<const Point> points);

  std::string svg_;
};

/// Width of the text at a font size, from the average widths of the characters of sans-serif faces.
double TextWidth(std::string_view text, double font_size);

}  // namespace vmech::plot
