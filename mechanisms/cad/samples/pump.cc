#include <cmath>

#include "samples.h"

namespace vmech::samples {
namespace {

constexpr double kCrank = 40, kRod = 130, kAngle = 0.7;  // [mm, rad]
constexpr double kPlay = 0.15;                           // [mm] at either end of a fit
constexpr double kWidth = 20;                            // of the rod
const Vector3d kX{1, 0, 0}, kZ{0, 0, 1};

/// A journal bearing of 20.02 mm along z and a liner of 60.04 mm along x.
TopoDS_Shape HousingShape() {
  const TopoDS_Shape block = Box({-30, -40, -45}, {30, 40, -10.05});
  const TopoDS_Shape foot = Box({-30, -60, -45}, {250, -40, 65});
  const TopoDS_Shape liner = Box({100, -40, -30}, {250, 40, 50});
  const TopoDS_Shape housing = Join(Join(block, foot), liner);
  const TopoDS_Shape bored = Cut(housing, Cylinder({100, 0, 10.15}, kX, 30.02, 150));
  return Cut(bored, Cylinder({0, 0, -45}, kZ, 10.01, 34.95));
}

/// A journal of 20 mm and a web with a bore of 12 mm for the pin.
TopoDS_Shape CrankShape() {
  const TopoDS_Shape web =
      Join(Box({-15, -15, -10}, {55, 15, 0}), Cylinder({0, 0, -50}, kZ, 10, 40));
  return Cut(web, Cylinder({kCrank, 0, -10}, kZ, 6, 10));
}

/// 12 mm, with a head that keeps the rod on it.
TopoDS_Shape CrankPinShape() {
  const double top = kWidth + 2 * kPlay;
  return Join(Cylinder({0, 0, -10}, kZ, 6, 10 + top), Cylinder({0, 0, top}, kZ, 9, 4));
}

TopoDS_Shape RodShape() {
  const TopoDS_Shape eyes =
      Join(Box({-15, -15, 0}, {15, 15, kWidth}), Box({kRod - 12, -12, 0}, {kRod + 12, 12, kWidth}));
  const TopoDS_Shape rod = Join(eyes, Box({15, -8, 4}, {kRod - 12, 8, 16}));
  const TopoDS_Shape bored = Cut(rod, Cylinder({0, 0, 0}, kZ, 6.015, kWidth));
  return Cut(bored, Cylinder({kRod, 0, 0}, kZ, 5, kWidth));
}

/// Two lugs beside the rod, bored to 10 mm, and a crown of 60 mm.
TopoDS_Shape PistonShape() {
  const double low = -kPlay, high = kWidth + kPlay;
  const TopoDS_Shape lugs =
      Join(Box({-10, -10, low - 12}, {25, 10, low}), Box({-10, -10, high}, {25, 10, high + 12}));
  const TopoDS_Shape bored = Cut(lugs, Cylinder({0, 0, -20}, kZ, 5, 60));
  return Join(bored, Cylinder({25, 0, 10}, kX, 30, 25));
}

}  // namespace

void BuildPump(StepWriter* step) {
  const double rod_angle = -std::asin(kCrank * std::sin(kAngle) / kRod);
  const Vector3d crank_x{std::cos(kAngle), std::sin(kAngle), 0};
  const Vector3d rod_x{std::cos(rod_angle), std::sin(rod_angle), 0};
  const Vector3d pin = kCrank * crank_x, wrist = pin + kRod * rod_x, lift{0, 0, kPlay};
  step->AddPart(step->root(), "housing", HousingShape());
  step->AddPart(step->root(), "crank", CrankShape(), At({0, 0, 0}, kZ, crank_x));
  step->AddPart(step->root(), "crank-pin", CrankPinShape(), At(pin));
  step->AddPart(step->root(), "rod", RodShape(), At(pin + lift, kZ, rod_x));
  step->AddPart(step->root(), "wrist-pin", Cylinder({0, 0, -12}, kZ, 4.99, kWidth + 24),
                At(wrist + lift));
  step->AddPart(step->root(), "piston", PistonShape(), At(wrist + lift));
}

}  // namespace vmech::samples
