#include "vmech/apps/drawing/mechanism_drawing.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>
#include <utility>
#include <vector>

#include "vmech/apps/drawing/drawing_style.h"
#include "vmech/apps/drawing/joint_symbol.h"
#include "vmech/apps/drawing/sheet.h"
#include "vmech/apps/plot/labels.h"
#include "vmech/apps/plot/scale.h"
#include "vmech/apps/plot/style.h"
#include "vmech/apps/plot/svg.h"
#include "vmech/mechanisms/freedoms.h"

namespace vmech {
namespace {

using plot::Point;
using plot::SvgWriter;

constexpr double kFont = 12, kRow = 21;  // of the list below
constexpr double kLeft = 20;

/// The corners of the convex hull (Andrew's monotone chain); two for points on a line.
std::vector<Point> ConvexHull(std::vector<Point> points) {
  constexpr double kFlat = 1;  // twice the area of a triangle that is a line to the eye
  const auto turn = [](const Point& a, const Point& b, const Point& c) {
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
  };
  std::sort(points.begin(), points.end(),
            [](const Point& a, const Point& b) { return a.x < b.x || (a.x == b.x && a.y < b.y); });
  std::vector<Point> hull;
  for (int side = 0; side < 2; ++side) {
    const size_t start = hull.size();
    for (const Point& p : points) {
      while (hull.size() >= start + 2 && turn(hull[hull.size() - 2], hull.back(), p) <= kFlat) {
        hull.pop_back();
      }
      hull.push_back(p);
    }
    hull.pop_back();
    std::reverse(points.begin(), points.end());
  }
  return hull;
}

std::string Coloured(std::string_view css, char role, int link) {
  return fmt::format("{} {}{}", css, role, link % plot::kPaletteSize + 1);
}

std::string ViewInWords(const View& view) {
  if (!view.planar) return "Isometric view; lengths in the plane of the drawing are to scale.";
  Eigen::Index axis = 0;
  if (view.toward.cwiseAbs().maxCoeff(&axis) < 1 - 1e-9) return "Seen along its axes, to scale.";
  return fmt::format("Seen along {}, to scale.", "xyz"[axis]);
}

/// A slide has the colour of the link that slides.
JointSymbol SymbolOf(const Sheet& sheet, const Joint& joint) {
  const bool held = joint.second.link == sheet.mechanism.ground;
  const int slider = held ? joint.first.link : joint.second.link;
  return {joint.type, sheet.At(sheet.AnchorInWorld(joint.second)),
          sheet.Direction(sheet.AxisInWorld(joint)), Coloured("slider", 's', slider)};
}

void DrawGrounds(const Sheet& sheet, SvgWriter* svg) {
  const int ground = sheet.mechanism.ground;
  for (const Joint& joint : sheet.mechanism.joints) {
    if (joint.first.link != ground && joint.second.link != ground) continue;
    DrawGround(SymbolOf(sheet, joint), svg);
  }
}

void DrawLink(const Sheet& sheet, int link, SvgWriter* svg) {
  std::vector<Point> points;
  for (const Vector3d& p : sheet.PlacesOf(link)) points.push_back(sheet.At(p));
  if (points.size() < 2) return;
  std::vector<Point> hull = ConvexHull(points);
  if (hull.size() > 2) {
    svg->Polygon(Coloured("plate", 'f', link), hull);
    hull.push_back(hull.front());
  }
  svg->Polyline(Coloured("bar", 's', link), hull);
}

/// May the anchors of a joint be apart?
bool Slides(const Joint& joint) {
  const std::vector<bool>& rotates = FreedomsOfType(joint.type).rotates;
  return joint.type == JointType::kScrew ||
         std::find(rotates.begin(), rotates.end(), false) != rotates.end();
}

void DrawJoints(const Sheet& sheet, SvgWriter* svg) {
  for (const Joint& joint : sheet.mechanism.joints) {
    const Vector3d first = sheet.AnchorInWorld(joint.first);
    const Vector3d second = sheet.AnchorInWorld(joint.second);
    if (sheet.scale * (second - first).norm() > 0.5) {
      svg->Line(Slides(joint) ? "axis" : "gap", sheet.At(first), sheet.At(second));
    }
    DrawJoint(SymbolOf(sheet, joint), svg);
  }
}

void DrawGrasps(const Sheet& sheet, SvgWriter* svg) {
  constexpr double kSize = 6;
  for (const Grasp& grasp : sheet.mechanism.grasps) {
    const Point p = sheet.At(sheet.GraspInWorld(grasp));
    const std::vector<Vector3d> places = sheet.PlacesOf(grasp.link);
    if (!places.empty() && grasp.link != sheet.mechanism.ground) {
      Vector3d middle = Vector3d::Zero();
      for (const Vector3d& place : places) middle += place / static_cast<double>(places.size());
      svg->Line(Coloured("arm", 's', grasp.link), sheet.At(middle), p);
    }
    const std::array<Point, 4> diamond = {
        {{p.x, p.y - kSize}, {p.x + kSize, p.y}, {p.x, p.y + kSize}, {p.x - kSize, p.y}}};
    svg->Polygon("symbol", diamond);
  }
}

/// Beside what they name, where there is room; all of them are in the list below.
void DrawNames(const Sheet& sheet, SvgWriter* svg) {
  plot::LabelPlacer placer({8, sheet.top}, {sheet.width - 8, sheet.bottom});
  for (const Joint& joint : sheet.mechanism.joints) {
    placer.Place(sheet.At(sheet.AnchorInWorld(joint.second)), joint.name, svg);
  }
  for (const Grasp& grasp : sheet.mechanism.grasps) {
    placer.Place(sheet.At(sheet.GraspInWorld(grasp)), grasp.name, svg);
  }
}

/// The axes of the world, at the upper right.
void DrawAxes(const Sheet& sheet, SvgWriter* svg) {
  constexpr double kLength = 26, kSeen = 0.2;
  const Point at{sheet.width - 64, 44};
  for (const int axis : {0, 1, 2}) {
    const Point d = sheet.Direction(Vector3d::Unit(axis));
    if (std::hypot(d.x, d.y) < kSeen) continue;
    svg->Line("scale", at, {at.x + kLength * d.x, at.y + kLength * d.y});
    svg->Text("soft mid", {at.x + (kLength + 10) * d.x, at.y + (kLength + 10) * d.y + 4},
              std::string_view("xyz").substr(static_cast<size_t>(axis), 1));
  }
}

/// A length of 1, 2 or 5 at the lower left.
void DrawScale(const Sheet& sheet, SvgWriter* svg) {
  constexpr double kLongest = 150;
  const double longest = kLongest / sheet.scale;  // [m]
  const double power = std::pow(10, std::floor(std::log10(longest)));
  double length = power;
  for (const double step : {2.0, 5.0}) {
    if (step * power <= longest) length = step * power;
  }
  const double y = sheet.bottom - 6, end = kLeft + sheet.scale * length;
  svg->Line("scale", {kLeft, y}, {end, y});
  for (const double x : {kLeft, end}) svg->Line("scale", {x, y - 4}, {x, y + 4});
  svg->Text("", {end + 8, y + 4}, plot::FormatShort(1e3 * length, 6) + " mm");
}

/// A part in the list below the picture.
struct Entry {
  std::string text;
  int link = -1;  ///< whose colour stands before it
  Point at;
};

/// Links with their colours, joints with their types, grasps; each kind begins a row.
std::vector<Entry> ListParts(const Sheet& sheet) {
  constexpr double kSwatch = 24, kGap = 22;
  const Mechanism& mechanism = sheet.mechanism;
  std::vector<Entry> entries;
  Point at{kLeft, sheet.bottom + kRow};
  const auto add = [&](const std::string& text, int link) {
    const double entry = (link < 0 ? 0 : kSwatch) + plot::TextWidth(text, kFont);
    if (at.x > kLeft && at.x + entry > sheet.width - kLeft) at = {kLeft, at.y + kRow};
    entries.push_back({text, link, at});
    at.x += entry + kGap;
  };
  const auto begin_row = [&] {
    if (at.x > kLeft) at = {kLeft, at.y + kRow};
  };
  for (int link = 0; link < static_cast<int>(mechanism.links.size()); ++link) {
    add(mechanism.links[link].name + (link == mechanism.ground ? " (ground)" : ""), link);
  }
  begin_row();
  for (const Joint& joint : mechanism.joints) {
    add(fmt::format("{} ({})", joint.name, NameOf(joint.type)), -1);
  }
  begin_row();
  for (const Grasp& grasp : mechanism.grasps) add(grasp.name + " (grasp)", -1);
  return entries;
}

void DrawList(const Sheet& sheet, const std::vector<Entry>& entries, SvgWriter* svg) {
  for (const Entry& entry : entries) {
    if (entry.link < 0) {
      svg->Text("soft", entry.at, entry.text);
      continue;
    }
    const Point from{entry.at.x + 4, entry.at.y - 4}, to{entry.at.x + 16, entry.at.y - 4};
    const bool ground = entry.link == sheet.mechanism.ground;
    svg->Line(ground ? "ground" : Coloured("bar", 's', entry.link), from, to);
    svg->Text("", {entry.at.x + 24, entry.at.y}, entry.text);
  }
}

}  // namespace

std::string DrawMechanism(const KinematicTree& tree) {
  const Sheet sheet(tree);
  const std::string& name = sheet.mechanism.name;
  const std::vector<Entry> entries = ListParts(sheet);
  const std::string words = ViewInWords(sheet.view);
  SvgWriter svg(sheet.width, entries.back().at.y + kRow, name, words);
  svg.Text("title", {kLeft, 26}, name);
  svg.Text("soft", {kLeft, 44}, words);
  DrawGrounds(sheet, &svg);
  for (int link = 0; link < static_cast<int>(sheet.mechanism.links.size()); ++link) {
    if (link != sheet.mechanism.ground) DrawLink(sheet, link, &svg);
  }
  DrawJoints(sheet, &svg);
  DrawGrasps(sheet, &svg);
  DrawNames(sheet, &svg);
  DrawAxes(sheet, &svg);
  DrawScale(sheet, &svg);
  DrawList(sheet, entries, &svg);
  return plot::StandaloneSvg(std::move(svg).Finish(), kDrawingStyle);
}

}  // namespace vmech
