#include <cmath>
#include <numbers>

#include "samples.h"

namespace vmech::samples {
namespace {

constexpr double kCrank = 50, kRod = 150;  // [mm]
constexpr double kCrankAngle = 40 * std::numbers::pi / 180;
const Vector3d kZ{0, 0, 1};

TopoDS_Shape FrameShape() {
  const TopoDS_Shape block = Box({-30, -40, -45}, {30, 30, -10});
  const TopoDS_Shape plate = Box({-30, -50, -45}, {250, -40, 65});
  const TopoDS_Shape stand = Box({170, -40, -20}, {200, -20, 40});
  const TopoDS_Shape liner = Cylinder({120, 0, 10}, {1, 0, 0}, 36, 130);
  TopoDS_Shape frame = Join(Join(block, plate), Join(stand, liner));
  frame = Cut(frame, Cylinder({120, 0, 10}, {1, 0, 0}, 30, 130));
  return Cut(frame, Cylinder({0, 0, -45}, kZ, 10, 35));
}

TopoDS_Shape CrankShape() {
  const TopoDS_Shape journal = Cylinder({0, 0, -50}, kZ, 10, 40);
  const TopoDS_Shape web = Box({-15, -15, -10}, {65, 15, 0});
  return Join(Join(journal, web), Cylinder({kCrank, 0, 0}, kZ, 8.5, 20));
}

TopoDS_Shape RodShape() {
  const TopoDS_Shape big =
      Cut(Box({-20, -20, -10}, {20, 20, 10}), Cylinder({0, 0, -10}, kZ, 8.5, 20));
  const TopoDS_Shape shank = Box({20, -8, -6}, {135, 8, 6});
  const TopoDS_Shape small =
      Cut(Box({135, -15, -10}, {165, 15, 10}), Cylinder({kRod, 0, -10}, kZ, 6, 20));
  return Join(Join(big, shank), small);
}

TopoDS_Shape PistonShape() {
  const TopoDS_Shape lugs =
      Join(Box({-12, -12, -22}, {25, 12, -10}), Box({-12, -12, 10}, {25, 12, 22}));
  const TopoDS_Shape bored = Cut(lugs, Cylinder({0, 0, -22}, kZ, 6, 44));
  return Join(bored, Cylinder({25, 0, 0}, {1, 0, 0}, 30, 20));
}

}  // namespace

void BuildSliderCrank(StepWriter* step) {
  const double rod_angle = -std::asin(kCrank * std::sin(kCrankAngle) / kRod);
  const Vector3d crank_x{std::cos(kCrankAngle), std::sin(kCrankAngle), 0};
  const Vector3d rod_x{std::cos(rod_angle), std::sin(rod_angle), 0};
  const Vector3d pin = kCrank * crank_x + Vector3d(0, 0, 10);

  const StepWriter::Id frame = step->AddGroup(step->root(), "frame");
  step->AddPart(frame, "housing", FrameShape());
  step->AddFrame(frame, "anchor_main", At({0, 0, -27.5}));
  step->AddFrame(frame, "anchor_guide__prismatic", At({0, 0, 10}, {1, 0, 0}, {0, 1, 0}));

  const StepWriter::Id crank = step->AddGroup(step->root(), "crank", At({0, 0, 0}, kZ, crank_x));
  step->AddPart(crank, "crankshaft", CrankShape());
  step->AddFrame(crank, "anchor_main", At({0, 0, -27.5}));
  step->AddFrame(crank, "anchor_pin", At({kCrank, 0, 10}));

  const StepWriter::Id rod = step->AddGroup(step->root(), "rod", At(pin, kZ, rod_x));
  step->AddPart(rod, "connecting-rod", RodShape());
  step->AddFrame(rod, "anchor_pin", At({0, 0, 0}));
  step->AddFrame(rod, "anchor_wrist", At({kRod, 0, 0}));
  step->AddFrame(rod, "grasp_handle", At({100, 0, 0}));

  const StepWriter::Id piston = step->AddGroup(step->root(), "piston", At(pin + kRod * rod_x));
  step->AddPart(piston, "piston-body", PistonShape());
  step->AddPart(piston, "wrist-pin", Cylinder({0, 0, -22}, kZ, 6, 44));
  step->AddFrame(piston, "anchor_wrist", At({0, 0, 0}));
  step->AddFrame(piston, "anchor_guide__prismatic", At({0, 0, 0}, {1, 0, 0}, {0, 1, 0}));
}

}  // namespace vmech::samples
