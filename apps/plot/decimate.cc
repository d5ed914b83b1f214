#include "vmech/apps/plot/decimate.h"

#include <algorithm>
#include <cmath>

namespace vmech::plot {
namespace {

bool Finite(const Point& p) {
  return std::isfinite(p.x) && std::isfinite(p.y);
}

bool RunsForward(const std::vector<Point>& points) {
  const Point* last = nullptr;
  for (const Point& p : points) {
    if (!Finite(p)) continue;
    if (last && p.x < last->x) return false;
    last = &p;
  }
  return true;
}

/// Appends the points of [begin, end) that must stay: ends and extremes, each once, in order.
void AppendColumn(const std::vector<Point>& points, std::size_t begin, std::size_t end,
                  std::vector<Point>* kept) {
  const auto first = points.begin() + static_cast<std::ptrdiff_t>(begin);
  const auto last = points.begin() + static_cast<std::ptrdiff_t>(end);
  const auto [low, high] =
      std::minmax_element(first, last, [](const Point& a, const Point& b) { return a.y < b.y; });
  for (const auto& p : {first, std::min(low, high), std::max(low, high), last - 1}) {
    if (kept->empty() || kept->back().x != p->x || kept->back().y != p->y) kept->push_back(*p);
  }
}

/// Leaves out points that are nearer to the last kept one than can be seen.
std::vector<Point> ThinOut(const std::vector<Point>& points, double near) {
  std::vector<Point> kept;
  kept.reserve(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Point& p = points[i];
    const bool ends = i == 0 || i + 1 == points.size() || !Finite(points[i + 1]);
    if (!ends && Finite(p) && Finite(kept.back()) &&
        std::hypot(p.x - kept.back().x, p.y - kept.back().y) < near) {
      continue;
    }
    kept.push_back(p);
  }
  return kept;
}

}  // namespace

std::vector<Point> Decimate(std::vector<Point> points, double column) {
  if (points.size() < 3) return points;
  if (!RunsForward(points)) return ThinOut(points, column / 2);
  std::vector<Point> kept;
  kept.reserve(points.size());
  for (std::size_t begin = 0; begin < points.size();) {
    if (!Finite(points[begin])) {
      kept.push_back(points[begin++]);
      continue;
    }
    const double index = std::floor(points[begin].x / column);
    std::size_t end = begin + 1;
    while (end < points.size() && Finite(points[end]) &&
           std::floor(points[end].x / column) == index) {
      ++end;
    }
    AppendColumn(points, begin, end, &kept);
    begin = end;
  }
  return kept;
}

}  // namespace vmech::plot
