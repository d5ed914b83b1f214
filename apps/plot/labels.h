#pragma once

#include <string_view>
#include <vector>

#include "vmech/apps/plot/svg.h"

namespace vmech::plot {

/// Puts short labels beside points so that they neither overlap nor leave the frame. Labels placed
/// first have the better places.
class LabelPlacer {
 public:
  LabelPlacer(Point top_left, Point bottom_right)
      : top_left_(top_left), bottom_right_(bottom_right) {}

  /// Writes the label at the first free place around the point: above, below, right, left.
  void Place(Point at, std::string_view text, SvgWriter* svg);

 private:
  struct Box {
    double left, top, right, bottom;
  };
  bool Free(const Box& box) const;

  Point top_left_, bottom_right_;
  std::vector<Box> taken_;
};

}  // namespace vmech::plot
