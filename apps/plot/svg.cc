#include "vmech/apps/plot/svg.h"

#include <charconv>
#include <cmath>
#include <utility>

namespace vmech::plot {
namespace {

constexpr double kLargest = 1e7;  // coordinates beyond are as good as at infinity

long Hundredths(double value) {
  const double bounded = value > kLargest ? kLargest : (value < -kLargest ? -kLargest : value);
  return std::lround(bounded * 100);
}

/// value / 100 without trailing zeros: 150 -> "1.5", -5 -> "-.05".
void AppendHundredths(long value, std::string* text) {
  if (value < 0) *text += '-', value = -value;
  const long whole = value / 100;
  const long rest = value % 100;
  if (whole != 0 || rest == 0) {
    char digits[24];
    text->append(digits, std::to_chars(digits, digits + sizeof(digits), whole).ptr);
  }
  if (rest == 0) return;
  *text += '.';
  *text += static_cast<char>('0' + rest / 10);
  if (rest % 10 != 0) *text += static_cast<char>('0' + rest % 10);
}

void AppendPair(long x, long y, std::string* text) {
  AppendHundredths(x, text);
  if (y >= 0) *text += ' ';
  AppendHundredths(y, text);
}

}  // namespace

SvgWriter::SvgWriter(double width, double height, std::string_view title,
                     std::string_view description) {
  svg_.reserve(1 << 14);
  svg_ += "<svg xmlns=\"http://www.w3.org/2000/svg\" class=\"plot\" role=\"img\"";
  Number("width", width);
  Number("height", height);
  svg_ += " viewBox=\"0 0 ";
  AppendPair(Hundredths(width), Hundredths(height), &svg_);
  svg_ += "\"><title>" + html::EscapeText(title) + "</title>";
  if (!description.empty()) svg_ += "<desc>" + html::EscapeText(description) + "</desc>";
  svg_ += '\n';
}

void SvgWriter::Open(std::string_view element, std::string_view css) {
  svg_.append("<").append(element);
  if (!css.empty()) svg_.append(" class=\"").append(css).append("\"");
}

void SvgWriter::Number(std::string_view attribute, double value) {
  svg_.append(" ").append(attribute).append("=\"");
  AppendHundredths(Hundredths(value), &svg_);
  svg_ += '"';
}

void SvgWriter::Line(std::string_view css, Point from, Point to) {
  Open("line", css);
  Number("x1", from.x);
  Number("y1", from.y);
  Number("x2", to.x);
  Number("y2", to.y);
  svg_ += "/>\n";
}

void SvgWriter::Circle(std::string_view css, Point center, double radius) {
  Open("circle", css);
  Number("cx", center.x);
  Number("cy", center.y);
  Number("r", radius);
  svg_ += "/>\n";
}

void SvgWriter::Text(std::string_view css, Point at, std::string_view text) {
  Open("text", css);
  Number("x", at.x);
  Number("y", at.y);
  svg_.append(">").append(html::EscapeText(text)).append("</text>\n");
}

void SvgWriter::PathData(std::span<const Point> points) {
  bool drawing = false;
  long last_x = 0, last_y = 0;
  for (const Point& point : points) {
    if (!std::isfinite(point.x) || !std::isfinite(point.y)) {
      drawing = false;
      continue;
    }
    const long x = Hundredths(point.x);
    const long y = Hundredths(point.y);
    if (drawing) {
      if (x == last_x && y == last_y) continue;
      svg_ += 'l';
      AppendPair(x - last_x, y - last_y, &svg_);
    } else {
      svg_ += 'M';
      AppendPair(x, y, &svg_);
    }
    drawing = true;
    last_x = x, last_y = y;
  }
}

void SvgWriter::Polyline(std::string_view css, std::span<const Point> points) {
  Open("path", css);
  svg_ += " d=\"";
  PathData(points);
  svg_ += "\"/>\n";
}

void SvgWriter::Polygon(std::string_view css, std::span<const Point> points) {
  Open("path", css);
  svg_ += " d=\"";
  PathData(points);
  svg_ += "z\"/>\n";
}

void SvgWriter::BeginClip(Point corner, double width, double height) {
  svg_ += "<svg";
  Number("x", corner.x);
  Number("y", corner.y);
  Number("width", width);
  Number("height", height);
  svg_ += " viewBox=\"";
  AppendPair(Hundredths(corner.x), Hundredths(corner.y), &svg_);
  svg_ += ' ';
  AppendPair(Hundredths(width), Hundredths(height), &svg_);
  svg_ += "\">";
}

void SvgWriter::EndClip() {
  svg_ += "</svg>\n";
}

html::Markup SvgWriter::Finish() && {
  svg_ += "</svg>\n";
  return html::Markup::Raw(std::move(svg_));
}

double TextWidth(std::string_view text, double font_size) {
  double ems = 0;
  for (const char c : text) {
    if ((static_cast<unsigned char>(c) & 0xC0) == 0x80) continue;  // inside a UTF-8 character
    if (std::string_view(" .,:;'|!ijlIft[]()-").find(c) != std::string_view::npos) {
      ems += 0.34;
    } else {
      ems += (c >= 'A' && c <= 'Z') || c == 'm' || c == 'w' ? 0.76 : 0.6;
    }
  }
  return ems * font_size;
}

}  // namespace vmech::plot
