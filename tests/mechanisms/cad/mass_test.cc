#include <gtest/gtest.h>

#include <BRepPrimAPI_MakeCone.hxx>
#include <BRepPrimAPI_MakeSphere.hxx>

#include "closed_forms.h"
#include "step_writer.h"
#include "support/temp_folder.h"
#include "vmech/mechanisms/cad/step/step_reader.h"

namespace vmech::mass_test {
namespace {

using samples::At;
using samples::Box;
using samples::Cut;
using samples::Cylinder;
using samples::Drawn;
using samples::Join;
using samples::StepWriter;

// STEP files have 15 digits or more; the volume integrals are exact for planes and good to 1e-12
// for the quadrics.
constexpr double kRelative = 1e-9;
const Vector3d kZ{0, 0, 1};

struct Solid {
  std::string name;
  TopoDS_Shape shape;
  Moments moments;  ///< in millimetres
};

Solid BoxSolid() {
  return {"box", Box({-3, 5, 1}, {17, 50, 8}), BoxMoments({-3, 5, 1}, {17, 50, 8})};
}

Solid CylinderSolid() {
  return {"cylinder", Cylinder({4, 0, -2}, kZ, 9, 31), CylinderMoments({4, 0, -2}, kZ, 9, 31)};
}

Solid TubeSolid() {
  return {"tube", Cut(Cylinder({0, 0, 0}, kZ, 12, 40), Cylinder({0, 0, 0}, kZ, 11, 40)),
          CylinderMoments({0, 0, 0}, kZ, 12, 40) - CylinderMoments({0, 0, 0}, kZ, 11, 40)};
}

/// rho = r (1 - z / h).
Solid ConeSolid() {
  const double r = 14, h = 37;
  return {"cone", BRepPrimAPI_MakeCone(r, 0, h).Shape(),
          RevolvedMoments(r * r * h / 3, std::pow(r, 4) * h / 5, r * r * h * h / 12,
                          r * r * h * h * h / 30)};
}

/// rho^2 = R^2 - z^2 from z = a to R.
Solid SphereSegment() {
  const double R = 20, a = 7;
  const auto integral = [&](auto primitive) { return primitive(R) - primitive(a); };
  const auto rho2 = [&](double z) { return R * R * z - z * z * z / 3; };
  const auto rho4 = [&](double z) {
    return std::pow(R, 4) * z - 2 * R * R * z * z * z / 3 + std::pow(z, 5) / 5;
  };
  const auto z_rho2 = [&](double z) { return R * R * z * z / 2 - std::pow(z, 4) / 4; };
  const auto z2_rho2 = [&](double z) { return R * R * z * z * z / 3 - std::pow(z, 5) / 5; };
  return {"sphere-segment", BRepPrimAPI_MakeSphere(R, std::asin(a / R), M_PI / 2).Shape(),
          RevolvedMoments(integral(rho2), integral(rho4), integral(z_rho2), integral(z2_rho2))};
}

Solid LBracket() {
  const TopoDS_Shape foot = Cut(Box({0, 0, 0}, {60, 40, 8}), Cylinder({40, 20, 0}, kZ, 5.5, 8));
  const TopoDS_Shape wall =
      Cut(Box({0, 0, 8}, {8, 40, 50}), Cylinder({0, 20, 32}, {1, 0, 0}, 7, 8));
  return {"l-bracket", Join(foot, wall),
          BoxMoments({0, 0, 0}, {60, 40, 8}) - CylinderMoments({40, 20, 0}, kZ, 5.5, 8) +
              BoxMoments({0, 0, 8}, {8, 40, 50}) - CylinderMoments({0, 20, 32}, {1, 0, 0}, 7, 8)};
}

class EverySolid : public testing::TestWithParam<Solid (*)()> {};

TEST_P(EverySolid, WeighsWhatItsClosedFormSaysDrawnAndPlacedAnyhow) {
  const Solid solid = GetParam()();
  const Posed drawn = At({31, -12, 77}, {1, 2, -0.5}, {1, 0, 0.3});
  const Posed placed = At({-250, 40, 9}, {-0.3, 0.2, 1}, {0, 1, 0});
  StepWriter step;
  step.AddPart(step.root(), solid.name, Drawn(drawn, solid.shape), placed);
  const TempFolder folder;
  step.Write(folder / "solid.step");

  const CadAssembly read = ReadStep(folder / "solid.step");
  ASSERT_EQ(read.parts.size(), 1u);
  EXPECT_EQ(read.parts[0].name, solid.name);
  const CadShape& shape = read.shapes[0];
  EXPECT_EQ(shape.defect, "");
  EXPECT_EQ(shape.volume.solids, 1);

  const Posed drawn_mm{drawn.R, 1e3 * drawn.p};
  const MassProperties expected = MassOf(Moved(drawn_mm, solid.moments), 1);
  EXPECT_NEAR(shape.volume.volume, expected.mass, kRelative * expected.mass);
  const double length = std::cbrt(expected.mass);
  EXPECT_LT((shape.volume.p_PoPcm - expected.p_LoLcm).norm(), kRelative * length);
  EXPECT_LT((shape.volume.moments - expected.I_Lcm).norm(), kRelative * expected.I_Lcm.norm());
  const Posed& X_WP = read.parts[0].X_WP;
  EXPECT_LT((X_WP.R - placed.R).norm() + (X_WP.p - placed.p).norm(), kRelative);
}

INSTANTIATE_TEST_SUITE_P(Solids, EverySolid,
                         testing::Values(BoxSolid, CylinderSolid, TubeSolid, ConeSolid,
                                         SphereSegment, LBracket));

}  // namespace
}  // namespace vmech::mass_test
