#include "vmech/apps/drawing/joint_symbol.h"

#include <array>
#include <cmath>

namespace vmech {
namespace {

using plot::Point;
using plot::SvgWriter;

constexpr double kRadius = 6;
constexpr double kBoxLength = 15, kBoxWidth = 8;  // halves
constexpr double kInPlane = 0.3;                  // of an axis whose direction is seen

/// A point beside another: `along` a unit vector and `across` it, to its right on the paper.
Point Beside(const Point& at, const Point& unit, double along, double across) {
  return {at.x + along * unit.x - across * unit.y, at.y + along * unit.y + across * unit.x};
}

double LengthOf(const Point& v) {
  return std::hypot(v.x, v.y);
}

/// The direction of an axis on the paper; to the right where it points at the eye.
Point Direction(const Point& axis) {
  const double length = LengthOf(axis);
  return length < 1e-6 ? Point{1, 0} : Point{axis.x / length, axis.y / length};
}

void DrawBox(const JointSymbol& joint, double length, double width, SvgWriter* svg) {
  const Point u = Direction(joint.axis);
  const std::array<Point, 4> corners = {
      Beside(joint.at, u, -length, -width), Beside(joint.at, u, length, -width),
      Beside(joint.at, u, length, width), Beside(joint.at, u, -length, width)};
  svg->Polygon(joint.box_css, corners);
}

/// The line about which a joint turns, where it is not seen end-on.
void DrawAxis(const JointSymbol& joint, SvgWriter* svg) {
  constexpr double kReach = 22;
  const double reach = kReach * LengthOf(joint.axis);
  if (LengthOf(joint.axis) < kInPlane) return;
  const Point u = Direction(joint.axis);
  svg->Line("axis", Beside(joint.at, u, -reach, 0), Beside(joint.at, u, reach, 0));
}

void DrawThread(const JointSymbol& joint, SvgWriter* svg) {
  const Point u = Direction(joint.axis);
  for (const double along : {-8.0, 0.0, 8.0}) {
    svg->Line("detail", Beside(joint.at, u, along - 3, kBoxWidth),
              Beside(joint.at, u, along + 3, -kBoxWidth));
  }
}

void DrawCross(const JointSymbol& joint, SvgWriter* svg) {
  constexpr double kArm = 0.7 * kRadius;
  for (const double side : {-1.0, 1.0}) {
    svg->Line("detail", {joint.at.x - kArm, joint.at.y - side * kArm},
              {joint.at.x + kArm, joint.at.y + side * kArm});
  }
}

/// Short strokes under a line from one point along a direction.
void DrawHatches(const Point& from, const Point& unit, double length, SvgWriter* svg) {
  constexpr double kStep = 5, kDepth = 6;
  for (double along = kStep / 2; along < length; along += kStep) {
    svg->Line("hatch", Beside(from, unit, along, 0), Beside(from, unit, along - kDepth, kDepth));
  }
}

}  // namespace

void DrawJoint(const JointSymbol& joint, SvgWriter* svg) {
  switch (joint.type) {
    case JointType::kRevolute:
      DrawAxis(joint, svg);
      svg->Circle("symbol", joint.at, kRadius);
      break;
    case JointType::kPrismatic:
      DrawBox(joint, kBoxLength, kBoxWidth, svg);
      break;
    case JointType::kCylindrical:
      DrawAxis(joint, svg);
      DrawBox(joint, kBoxLength, kBoxWidth, svg);
      svg->Circle("symbol", joint.at, kBoxWidth - 2);
      break;
    case JointType::kScrew:
      DrawAxis(joint, svg);
      DrawBox(joint, kBoxLength, kBoxWidth, svg);
      DrawThread(joint, svg);
      break;
    case JointType::kUniversal:
      svg->Circle("symbol", joint.at, kRadius);
      DrawCross(joint, svg);
      break;
    case JointType::kSpherical:
      svg->Circle("symbol", joint.at, kRadius + 1.5);
      svg->Circle("symbol", joint.at, kRadius - 1.5);
      break;
    case JointType::kPlanar:
      DrawBox(joint, kBoxLength, kBoxLength, svg);
      break;
    case JointType::kWeld:
      DrawBox(joint, kRadius - 1, kRadius - 1, svg);
      DrawCross(joint, svg);
      break;
  }
  svg->Circle("pivot", joint.at, 1.4);
}

void DrawGround(const JointSymbol& joint, SvgWriter* svg) {
  if (joint.type == JointType::kPrismatic && LengthOf(joint.axis) > kInPlane) {
    constexpr double kReach = 46;
    Point u = Direction(joint.axis);
    if (u.x < 0) u = {-u.x, -u.y};  // the ground is below
    const Point from = Beside(joint.at, u, -kReach, kBoxWidth + 1);
    svg->Line("ground", from, Beside(from, u, 2 * kReach, 0));
    return DrawHatches(from, u, 2 * kReach, svg);
  }
  constexpr double kHeight = 17, kFoot = 10, kBase = 15;
  const Point& p = joint.at;
  const std::array<Point, 3> foot = {p, {p.x + kFoot, p.y + kHeight}, {p.x - kFoot, p.y + kHeight}};
  svg->Polygon("symbol", foot);
  svg->Line("ground", {p.x - kBase, p.y + kHeight}, {p.x + kBase, p.y + kHeight});
  DrawHatches({p.x - kBase, p.y + kHeight}, {1, 0}, 2 * kBase, svg);
}

}  // namespace vmech
