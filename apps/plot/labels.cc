#include "labels.h"

#include <array>

namespace vmech::plot {
namespace {

constexpr double kFont = 11.5;  // class `note` (style.cc)
constexpr double kHeight = 14;
constexpr double kGap = 8;

}  // namespace

bool LabelPlacer::Free(const Box& box) const {
  if (box.left < top_left_.x || box.right > bottom_right_.x || box.top < top_left_.y ||
      box.bottom > bottom_right_.y) {
    return false;
  }
  for (const Box& other : taken_) {
    if (box.left < other.right && other.left < box.right && box.top < other.bottom &&
        other.top < box.bottom) {
      return false;
    }
  }
  return true;
}

void LabelPlacer::Place(Point at, std::string_view text, SvgWriter* svg) {
  const double width = TextWidth(text, kFont);
  const double above = at.y - kGap, below = at.y + kGap + kHeight - 4, beside = at.y + 4;
  const double right = at.x + kGap, left = at.x - kGap - width, centred = at.x - width / 2;
  const std::array<Point, 8> places = {{{centred, above},
                                        {centred, below},
                                        {right, beside},
                                        {left, beside},
                                        {right, above},
                                        {left, above},
                                        {right, below},
                                        {left, below}}};
  for (const Point& place : places) {
    const Box box{place.x, place.y - kHeight + 3, place.x + width, place.y + 3};
    if (!Free(box)) continue;
    taken_.push_back(box);
    svg->Text("note halo", place, text);
    return;
  }
}

}  // namespace vmech::plot
