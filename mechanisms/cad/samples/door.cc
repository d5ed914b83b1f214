#include "samples.h"

namespace vmech::samples {
namespace {

// The hinge axis is parallel to z, 7.5 mm before the front face y = 0 of door and frame.
constexpr double kAxis = 7.5, kLeaf = 3, kHeight = 90;        // [mm]
constexpr double kBore = 4, kPin = 3.99;                      // radii
constexpr double kScrew = 2, kClearance = 2.25, kCore = 1.6;  // radii
constexpr double kLow = 200, kHigh = 1500;                    // feet of the hinges
const Vector3d kZ{0, 0, 1}, kInwards{0, -1, 0};

/// To be bored along the hinge axis; the plate of a leaf lies beside it, on the side of +x.
TopoDS_Shape Knuckle(double low, double high) {
  return Box({-7, 0.5, low}, {7, 14.5, high});
}

TopoDS_Shape Bored(TopoDS_Shape leaf) {
  leaf = Cut(leaf, Cylinder({0, kAxis, 0}, kZ, kBore, kHeight));
  for (const double z : {20.0, 70.0}) {
    leaf = Cut(leaf, Cylinder({25, kLeaf, z}, kInwards, kClearance, kLeaf));
  }
  return leaf;
}

TopoDS_Shape OuterLeaf() {
  const TopoDS_Shape plate = Box({7, 0, 0}, {40, kLeaf, kHeight});
  return Bored(Join(Join(plate, Knuckle(0, 30)), Knuckle(60, kHeight)));
}

/// Between the knuckles of the outer one, with a gap of 0.1 mm to each.
TopoDS_Shape InnerLeaf() {
  return Bored(Join(Box({7, 0, 0}, {40, kLeaf, kHeight}), Knuckle(30.1, 59.9)));
}

TopoDS_Shape PinShape() {
  return Join(Cylinder({0, 0, 0}, kZ, kPin, kHeight), Cylinder({0, 0, kHeight}, kZ, 6, 3));
}

/// Along z into the wood, the head before it.
TopoDS_Shape ScrewShape() {
  return Join(Cylinder({0, 0, 0}, kZ, kScrew, 28), Cylinder({0, 0, -2.4}, kZ, 3.75, 2.4));
}

/// A block with core holes, 30 mm deep, for the leaves of the two hinges.
TopoDS_Shape Drilled(TopoDS_Shape block, double x) {
  for (const double foot : {kLow, kHigh}) {
    for (const double z : {20.0, 70.0}) {
      block = Cut(block, Cylinder({x, 0, foot + z}, kInwards, kCore, 30));
    }
  }
  return block;
}

}  // namespace

void BuildDoor(StepWriter* step) {
  const StepWriter::Id outer = step->AddProduct("leaf-of-frame", OuterLeaf());
  const StepWriter::Id inner = step->AddProduct("leaf-of-door", InnerLeaf());
  const StepWriter::Id pin = step->AddProduct("pin", PinShape());
  const StepWriter::Id screw = step->AddProduct("screw", ScrewShape());
  step->AddPart(step->root(), "frame", Drilled(Box({-80, -40, 0}, {-2, 0, 1900}), -25));
  step->AddPart(step->root(), "door", Drilled(Box({2, -40, 5}, {700, 0, 1800}), 25));
  for (const double foot : {kLow, kHigh}) {
    // Half a turn about y brings the plate of the frame's leaf to -x.
    step->Place(step->root(), inner, "leaf-of-door", At({0, 0, foot}));
    step->Place(step->root(), outer, "leaf-of-frame", At({0, 0, foot + kHeight}, -kZ, {-1, 0, 0}));
    step->Place(step->root(), pin, "pin", At({0, kAxis, foot}));
    for (const double x : {-25.0, 25.0}) {
      for (const double z : {20.0, 70.0}) {
        step->Place(step->root(), screw, "screw", At({x, kLeaf, foot + z}, kInwards));
      }
    }
  }
}

}  // namespace vmech::samples
