#pragma once

#include <vector>

#include "vmech/apps/plot/svg.h"

namespace vmech::plot {

/// Thins out a long curve without changing what is seen: of the points in each column of `column`
/// drawing units the first, the lowest, the highest and the last remain, in their order, so that
/// every peak survives. Of a curve that turns back in x, points go that are nearer than half a
/// column to the last one that stays. Points that are not finite, which interrupt the curve,
/// remain.
std::vector<Point> Decimate(std::vector<Point> points, double column = 1);

}  // namespace vmech::plot
