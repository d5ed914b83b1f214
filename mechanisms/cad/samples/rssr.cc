#include <cmath>

#include "samples.h"

namespace vmech::samples {
namespace {

constexpr double kCrank = 40, kRocker = 110;  // [mm] from axis to ball
constexpr double kBall = 8;
const Vector3d kX{1, 0, 0}, kZ{0, 0, 1};
const Vector3d kPivot{150, 60, 40};  // of the rocker, which turns about x

/// A lever with a bore of 12 mm at its origin, and a ball on a stud at its end.
TopoDS_Shape Lever(double length) {
  const TopoDS_Shape bar =
      Cut(Box({-12, -10, -5}, {length - 14, 10, 5}), Cylinder({0, 0, -5}, kZ, 6, 10));
  const TopoDS_Shape stud = Cylinder({length - 14, 0, 0}, kX, 3, 14);
  return Join(Join(bar, stud), Ball({length, 0, 0}, kBall));
}

TopoDS_Shape FrameShape() {
  const TopoDS_Shape plate = Box({-40, -60, -25}, {220, 160, -15});
  const TopoDS_Shape main =
      Join(Cylinder({0, 0, -15}, kZ, 6, 20), Cylinder({0, 0, -15}, kZ, 10, 10));
  const TopoDS_Shape post = Box({158, 48, -15}, {176, 72, 55});
  const TopoDS_Shape pivot = Cylinder({145, 60, 40}, kX, 6, 13);
  return Join(Join(plate, main), Join(Join(post, pivot), Cylinder({155, 60, 40}, kX, 10, 3)));
}

/// A rod between two sockets, which are open to the sides away from it.
TopoDS_Shape RodShape(double length) {
  TopoDS_Shape rod = Cylinder({0, 0, 0}, kX, 5, length);
  for (const double x : {0.0, length}) {
    rod = Join(rod, Cylinder({x, 0, -6}, kZ, 14, 12));
  }
  for (const double x : {0.0, length}) rod = Cut(rod, Ball({x, 0, 0}, kBall));
  return rod;
}

}  // namespace

void BuildRssr(StepWriter* step) {
  const Vector3d crank_x{std::cos(0.7), std::sin(0.7), 0};
  const Vector3d rocker_x{0, std::cos(1.9), std::sin(1.9)};
  const Vector3d a = kCrank * crank_x;
  const Vector3d b = kPivot + kRocker * rocker_x;

  const StepWriter::Id frame = step->AddGroup(step->root(), "frame");
  step->AddPart(frame, "stand", FrameShape());
  step->AddFrame(frame, "anchor_main", At({0, 0, 0}));
  step->AddFrame(frame, "anchor_pivot", At(kPivot, kX, {0, 1, 0}));

  const StepWriter::Id crank = step->AddGroup(step->root(), "crank", At({0, 0, 0}, kZ, crank_x));
  step->AddPart(crank, "crank-lever", Lever(kCrank));
  step->AddFrame(crank, "anchor_main", At({0, 0, 0}));
  step->AddFrame(crank, "anchor_ball_a__ball", At({kCrank, 0, 0}));

  const Vector3d way = b - a;
  const Vector3d up = way.cross(kZ.cross(way));
  const double length = way.norm();
  const StepWriter::Id rod = step->AddGroup(step->root(), "rod", At(a, up, way));
  step->AddPart(rod, "rod-body", RodShape(length));
  step->AddFrame(rod, "anchor_ball_a__ball", At({0, 0, 0}));
  step->AddFrame(rod, "anchor_ball_b__ball", At({length, 0, 0}));
  step->AddFrame(rod, "grasp_middle__point", At({0.5 * length, 0, 0}));

  const StepWriter::Id rocker = step->AddGroup(step->root(), "rocker", At(kPivot, kX, rocker_x));
  step->AddPart(rocker, "rocker-lever", Lever(kRocker));
  step->AddFrame(rocker, "anchor_pivot", At({0, 0, 0}));
  step->AddFrame(rocker, "anchor_ball_b__ball", At({kRocker, 0, 0}));
}

}  // namespace vmech::samples
