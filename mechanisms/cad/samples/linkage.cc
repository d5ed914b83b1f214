#include <cmath>

#include "samples.h"

namespace vmech::samples {
namespace {

constexpr double kBase = 200, kCrank = 60, kCoupler = 180, kRocker = 120;  // [mm]
constexpr double kBore = 6, kBolt = 5.99, kThickness = 10;                 // radii
const Vector3d kZ{0, 0, 1};

/// Joints at the origin and on x, and a lug on the side of +y.
TopoDS_Shape Bar(double length) {
  const TopoDS_Shape bar = Join(Box({-12, -12, 0}, {length + 12, 12, kThickness}),
                                Box({15, 12, 0}, {25, 30, kThickness}));
  return Cut(Cut(bar, Cylinder({0, 0, 0}, kZ, kBore, kThickness)),
             Cylinder({length, 0, 0}, kZ, kBore, kThickness));
}

TopoDS_Shape BaseShape() {
  const TopoDS_Shape plate = Box({-40, -30, -kThickness}, {kBase + 40, 30, 0});
  return Cut(Cut(plate, Cylinder({0, 0, -kThickness}, kZ, kBore, kThickness)),
             Cylinder({kBase, 0, -kThickness}, kZ, kBore, kThickness));
}

/// Through two layers, its head on the upper one.
TopoDS_Shape BoltShape() {
  return Join(Cylinder({0, 0, -kThickness}, kZ, kBolt, 2 * kThickness),
              Cylinder({0, 0, kThickness}, kZ, 9, 4));
}

/// Where circles around the crank's pin and the rocker's pivot meet, above the base.
Vector3d Top(const Vector3d& pin, const Vector3d& pivot) {
  const Vector3d way = pivot - pin;
  const double d = way.norm();
  const double along = (d * d + kCoupler * kCoupler - kRocker * kRocker) / (2 * d);
  const double aside = std::sqrt(kCoupler * kCoupler - along * along);
  return pin + along * way / d + aside * kZ.cross(way / d);
}

}  // namespace

void BuildLinkage(StepWriter* step) {
  const Vector3d pin = kCrank * Vector3d(std::cos(1.0), std::sin(1.0), 0), pivot{kBase, 0, 0};
  const Vector3d top = Top(pin, pivot), layer{0, 0, kThickness};
  const StepWriter::Id bolt = step->AddProduct("Bolzen à", BoltShape());
  step->AddPart(step->root(), "Fuß", BaseShape());
  step->AddPart(step->root(), "Kurbel", Bar(kCrank), At({0, 0, 0}, kZ, pin));
  step->AddPart(step->root(), "Schwinge gespiegelt", Mirrored(Bar(kRocker)),
                At(pivot, kZ, top - pivot));
  const StepWriter::Id group = step->AddGroup(step->root(), "Übertragung groß", At(layer));
  step->AddPart(group, "Koppel ü", Bar(kCoupler), At(pin, kZ, top - pin));
  const StepWriter::Id bolts = step->AddGroup(group, "Bolzen ß", At(-layer));
  for (const Vector3d& p : {Vector3d(0, 0, 0), pivot}) step->Place(bolts, bolt, "Bolzen à", At(p));
  for (const Vector3d& p : {pin, top}) step->Place(bolts, bolt, "Bolzen à", At(p + layer));
}

}  // namespace vmech::samples
