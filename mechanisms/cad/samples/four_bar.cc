#include <cmath>

#include "samples.h"

namespace vmech::samples {
namespace {

constexpr double kGround = 200, kCrank = 60, kCoupler = 180, kRocker = 120;  // [mm]
constexpr double kPinRadius = 6, kThickness = 10;
const Vector3d kZ{0, 0, 1};

/// A bar with a bore at its beginning and, at its end, a pin that stands up into the next layer.
TopoDS_Shape BarWithPin(double length) {
  const TopoDS_Shape bar = Box({-12, -12, 0}, {length + 12, 12, kThickness});
  const TopoDS_Shape bored = Cut(bar, Cylinder({0, 0, 0}, kZ, kPinRadius, kThickness));
  return Join(bored, Cylinder({length, 0, kThickness}, kZ, kPinRadius, kThickness));
}

TopoDS_Shape BarWithBores(double length) {
  const TopoDS_Shape bar = Box({-12, -12, 0}, {length + 12, 12, kThickness});
  return Cut(Cut(bar, Cylinder({0, 0, 0}, kZ, kPinRadius, kThickness)),
             Cylinder({length, 0, 0}, kZ, kPinRadius, kThickness));
}

TopoDS_Shape FrameShape() {
  const TopoDS_Shape plate = Box({-40, -30, -kThickness}, {kGround + 40, 30, 0});
  return Join(Join(plate, Cylinder({0, 0, 0}, kZ, kPinRadius, kThickness)),
              Cylinder({kGround, 0, 0}, kZ, kPinRadius, kThickness));
}

Vector3d OnCircle(double radius, double angle) {
  return radius * Vector3d(std::cos(angle), std::sin(angle), 0);
}

/// Where circles around a and b meet, on the left of the way from a to b.
Vector3d Meet(const Vector3d& a, double radius_a, const Vector3d& b, double radius_b) {
  const Vector3d way = b - a;
  const double d = way.norm();
  const double along = (d * d + radius_a * radius_a - radius_b * radius_b) / (2 * d);
  const double aside = std::sqrt(radius_a * radius_a - along * along);
  return a + along * way / d + aside * kZ.cross(way / d);
}

}  // namespace

void BuildFourBar(StepWriter* step) {
  const Vector3d pin = OnCircle(kCrank, 1);
  const Vector3d pivot{kGround, 0, 0};
  const Vector3d top = Meet(pin, kCoupler, pivot, kRocker);
  const Vector3d layer{0, 0, kThickness};

  const StepWriter::Id frame = step->AddGroup(step->root(), "frame");
  step->AddPart(frame, "plate", FrameShape());
  step->AddFrame(frame, "dof_main", At({0, 0, 5}));
  step->AddFrame(frame, "dof_pivot", At(pivot + Vector3d(0, 0, 5)));

  const StepWriter::Id crank = step->AddGroup(step->root(), "crank", At({0, 0, 0}, kZ, pin));
  step->AddPart(crank, "crank-bar", BarWithPin(kCrank));
  step->AddFrame(crank, "dof_main", At({0, 0, 5}));
  step->AddFrame(crank, "dof_pin", At({kCrank, 0, 15}));

  const StepWriter::Id coupler =
      step->AddGroup(step->root(), "coupler", At(pin + layer, kZ, top - pin));
  step->AddPart(coupler, "coupler-bar", BarWithBores(kCoupler));
  step->AddFrame(coupler, "dof_pin", At({0, 0, 5}));
  step->AddFrame(coupler, "closing_top", At({kCoupler, 0, 5}));
  step->AddFrame(coupler, "grasp_tip__point", At({0.5 * kCoupler, 0, kThickness}));

  const StepWriter::Id rocker = step->AddGroup(step->root(), "rocker", At(pivot, kZ, top - pivot));
  step->AddPart(rocker, "rocker-bar", BarWithPin(kRocker));
  step->AddFrame(rocker, "dof_pivot", At({0, 0, 5}));
  step->AddFrame(rocker, "closing_top", At({kRocker, 0, 15}));
}

}  // namespace vmech::samples
