#include "samples.h"

namespace vmech::samples {
namespace {

constexpr double kUpper = 160, kFore = 130;  // [mm]
const Vector3d kX{1, 0, 0}, kY{0, 1, 0}, kZ{0, 0, 1};

/// A servo of 40 x 20 x 38 mm whose shaft (8 mm) stands on its z axis.
TopoDS_Shape ServoShape() {
  return Join(Box({-10, -10, -38}, {30, 10, 0}), Cylinder({0, 0, 0}, kZ, 4, 8));
}

/// An arm along x with a bore for the shaft of a servo (the axis is y) and a pocket's worth of
/// room for the next servo at its end.
TopoDS_Shape ArmShape(double length) {
  const TopoDS_Shape bar = Box({-12, 0, -8}, {length - 12, 8, 8});
  const TopoDS_Shape plate = Box({length - 12, 0, -12}, {length + 32, 8, 12});
  return Cut(Join(bar, plate), Cylinder({0, 0, 0}, kY, 4, 8));
}

TopoDS_Shape BaseShape() {
  return Cut(Box({-50, -50, -50}, {50, 50, -38}), Cylinder({30, 30, -50}, kZ, 3, 12));
}

TopoDS_Shape TurretShape() {
  const TopoDS_Shape disc = Cut(Cylinder({0, 0, 0}, kZ, 35, 8), Cylinder({0, 0, 0}, kZ, 4, 8));
  return Join(disc, Box({-14, -28, 8}, {34, -18, 60}));
}

TopoDS_Shape HandShape() {
  const TopoDS_Shape palm = Cut(Box({-12, 0, -15}, {40, 8, 15}), Cylinder({0, 0, 0}, kY, 4, 8));
  const TopoDS_Shape finger = Box({40, 0, -15}, {85, 8, -9});
  return Join(palm, Join(finger, Box({40, 0, 9}, {85, 8, 15})));
}

/// A servo with its shaft along +y, the face that carries it at y = 0.
Posed ServoAlongY(const Vector3d& p) {
  return At(p, kY, kX);
}

}  // namespace

void BuildArm(StepWriter* step) {
  const StepWriter::Id servo = step->AddProduct("servo", ServoShape());
  step->SetMaterial(servo, "servo (mean)", 1800);
  const Posed upright = At({0, 0, 0}, kZ, kX);

  const StepWriter::Id base = step->AddGroup(step->root(), "base");
  step->AddPart(base, "base-plate", BaseShape());
  step->Place(base, servo, "servo-yaw", upright);
  step->AddFrame(base, "anchor_yaw", At({0, 0, 4}));

  const StepWriter::Id turret = step->AddGroup(step->root(), "turret");
  step->AddPart(turret, "turret-body", TurretShape());
  step->Place(turret, servo, "servo-shoulder", ServoAlongY({0, 20, 45}));
  step->AddFrame(turret, "anchor_yaw", At({0, 0, 4}));
  step->AddFrame(turret, "anchor_shoulder", At({0, 24, 45}, kY, kX));

  const StepWriter::Id upper = step->AddGroup(step->root(), "upper-arm", At({0, 20, 45}));
  step->AddPart(upper, "upper-arm-bar", ArmShape(kUpper));
  step->Place(upper, servo, "servo-elbow", ServoAlongY({kUpper, 46, 0}));
  step->AddFrame(upper, "anchor_shoulder", At({0, 4, 0}, kY, kX));
  step->AddFrame(upper, "anchor_elbow", At({kUpper, 50, 0}, kY, kX));

  const StepWriter::Id fore = step->AddGroup(step->root(), "forearm", At({kUpper, 66, 45}));
  step->AddPart(fore, "forearm-bar", ArmShape(kFore));
  step->Place(fore, servo, "servo-wrist", ServoAlongY({kFore, 46, 0}));
  step->AddFrame(fore, "anchor_elbow", At({0, 4, 0}, kY, kX));
  step->AddFrame(fore, "anchor_wrist", At({kFore, 50, 0}, kY, kX));

  const StepWriter::Id hand = step->AddGroup(step->root(), "hand", At({kUpper + kFore, 112, 45}));
  step->AddPart(hand, "hand-body", HandShape());
  step->AddFrame(hand, "anchor_wrist", At({0, 4, 0}, kY, kX));
  step->AddFrame(hand, "grasp_fingers", At({80, 4, 0}, kX, kY));
}

}  // namespace vmech::samples
