#include "vmech/mechanisms/files/reader.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <limits>
#include <numbers>

#include "slider_crank.h"

namespace vmech::reader_test {
namespace {

constexpr double kRounding = 1e-15;  // relative; one or two roundings of the conversion
constexpr double kDegree = std::numbers::pi / 180;

TEST(Reader, ReadsTheSliderCrankInSiUnits) {
  const Mechanism mechanism = ParseMechanism(kSliderCrank, "slider-crank.yaml");
  EXPECT_EQ(mechanism.name, "slider-crank");
  EXPECT_EQ(mechanism.gravity_W, Vector3d(0, -9.81, 0));
  ASSERT_EQ(mechanism.links.size(), 4u);
  EXPECT_EQ(mechanism.ground, FindLink(mechanism, "frame"));
  const Link& crank = mechanism.links[FindLink(mechanism, "crank")];
  EXPECT_EQ(crank.mass_properties.mass, 0.4);
  EXPECT_NEAR(crank.mass_properties.p_LoLcm.x(), 0.025, kRounding);
  EXPECT_NEAR(crank.mass_properties.I_Lcm(2, 2), 110e-6, 110e-6 * kRounding);
  EXPECT_NEAR(crank.anchors[1].X_LA.p.x(), 0.05, kRounding);
}

TEST(Reader, ReadsJointsInTheOrderOfTheFile) {
  const Mechanism mechanism = ParseMechanism(kSliderCrank, "slider-crank.yaml");
  ASSERT_EQ(mechanism.joints.size(), 4u);
  const Joint& main = mechanism.joints[0];
  EXPECT_EQ(main.name, "main");
  EXPECT_NEAR(main.start[0], 40 * kDegree, kRounding);
  EXPECT_NEAR(main.upper[0], 720 * kDegree, 720 * kDegree * kRounding);
  EXPECT_EQ(mechanism.joints[1].passive[0].viscous, 0.01);
  const Joint& guide = mechanism.joints[3];
  EXPECT_EQ(guide.type, JointType::kPrismatic);
  EXPECT_EQ(guide.passive[0].stiffness, 800);
  EXPECT_NEAR(guide.passive[0].rest, 0.2, kRounding);
  EXPECT_EQ((*guide.stiffness)[1], 1e8);
  EXPECT_EQ(mechanism.anchor(guide.second).name, "guide");
  EXPECT_EQ(guide.second.link, FindLink(mechanism, "slider"));
}

TEST(Reader, ReadsGraspsAndCuts) {
  const Mechanism mechanism = ParseMechanism(kSliderCrank, "slider-crank.yaml");
  ASSERT_EQ(mechanism.grasps.size(), 1u);
  EXPECT_EQ(mechanism.grasps[0].link, FindLink(mechanism, "coupler"));
  EXPECT_NEAR(mechanism.grasps[0].X_LG.p.x(), 0.1, kRounding);
  EXPECT_EQ(mechanism.preferred_cuts, std::vector<int>{2});
}

/// A file with one link besides the frame, on a joint, from the lines of both.
Mechanism Parse(const std::string& link, const std::string& joint, const std::string& units = "") {
  return ParseMechanism("{vmech: \"1.0\", gravity: [0, 0, 0], ground: frame, units: {" + units +
                            "}, links: {frame: {anchors: {a: {}}}, body: {anchors: {a: {}}, " +
                            link + "}}, joints: {j: {connects: [frame/a, body/a], " + joint + "}}}",
                        "body.yaml");
}

Matrix3d InertiaOf(const std::string& mass_properties) {
  return Parse(mass_properties, "type: weld").links[1].mass_properties.I_Lcm;
}

Joint JointOf(const std::string& joint, const std::string& units = "") {
  return Parse("mass: 1", joint, units).joints[0];
}

TEST(Reader, GivesTheSameMechanismInMillimetresAndInMetres) {
  const Mechanism in_mm = ParseMechanism(kSliderCrank, "mm.yaml");
  const Mechanism in_m = ParseMechanism(kSliderCrankInSi, "si.yaml");
  ASSERT_EQ(in_mm.links.size(), in_m.links.size());
  for (size_t i = 0; i < in_m.links.size(); ++i) {
    const MassProperties &a = in_mm.links[i].mass_properties, &b = in_m.links[i].mass_properties;
    EXPECT_EQ(a.mass, b.mass);
    EXPECT_TRUE(a.p_LoLcm.isApprox(b.p_LoLcm, kRounding));
    EXPECT_TRUE(a.I_Lcm.isApprox(b.I_Lcm, kRounding));
    for (size_t k = 0; k < in_m.links[i].anchors.size(); ++k) {
      const Posed &X = in_mm.links[i].anchors[k].X_LA, &Y = in_m.links[i].anchors[k].X_LA;
      EXPECT_EQ(X.R, Y.R);
      EXPECT_TRUE(X.p.isApprox(Y.p, kRounding));
    }
  }
  for (size_t i = 0; i < in_m.joints.size(); ++i) {
    const Joint &a = in_mm.joints[i], &b = in_m.joints[i];
    EXPECT_NEAR(a.start[0], b.start[0], std::abs(b.start[0]) * kRounding);
    EXPECT_NEAR(a.passive[0].rest, b.passive[0].rest, kRounding);
    EXPECT_EQ(a.passive[0].stiffness, b.passive[0].stiffness);
    EXPECT_EQ(a.passive[0].viscous, b.passive[0].viscous);
  }
}

TEST(Reader, TakesTheMatrixElementsOrTheProductsOfInertia) {
  const Matrix3d elements = InertiaOf("mass: 1, inertia: {xx: 2, yy: 3, zz: 4, xy: -0.1, yz: 0.2}");
  EXPECT_EQ(elements(0, 1), -0.1);
  EXPECT_EQ(elements(2, 1), 0.2);
  EXPECT_EQ(elements, InertiaOf("mass: 1, inertia: {off_diagonal: products_of_inertia,"
                                " xx: 2, yy: 3, zz: 4, xy: 0.1, yz: -0.2}"));
}

TEST(Reader, MovesAnInertiaFromTheOriginToTheCenterOfGravity) {
  const Matrix3d I = InertiaOf(
      "mass: 2, center_of_gravity: [0.5, 0, 0], inertia: {about: origin, xx: 1, yy: 1.5, zz: 2.5}");
  EXPECT_TRUE(I.isApprox(Matrix3d(Vector3d(1, 1, 2).asDiagonal()), kRounding));
}

TEST(Reader, TurnsPrincipalMomentsIntoTheAxesOfTheLink) {
  const Matrix3d I = InertiaOf(
      "mass: 1, inertia: {principal: [2, 3, 4], axes: {z: [1, 0, 0], x: [0, 1, 0], y: [0, 0, 1]}}");
  EXPECT_TRUE(I.isApprox(Matrix3d(Vector3d(4, 2, 3).asDiagonal()), kRounding));
}

TEST(Reader, TakesALinkWithoutInertiaForAPoint) {
  EXPECT_TRUE(InertiaOf("mass: 3, center_of_gravity: [1, 2, 3]").isZero(0));
}

TEST(Reader, TakesMassesFromZeroInAFileForKinematicsOnly) {
  EXPECT_EQ(Parse("description: no mass at all", "type: revolute").links[1].mass_properties.mass,
            0);
}

TEST(Reader, StartsABallAtARotationVectorOrAQuaternion) {
  const Joint vector = JointOf("type: spherical, start: [0, 0, 90]", "angle: deg");
  EXPECT_NEAR(vector.start[0], std::sqrt(0.5), kRounding);
  EXPECT_NEAR(vector.start[3], std::sqrt(0.5), kRounding);
  const Joint quaternion = JointOf("type: spherical, start: [0.5, 0.5, -0.5, 0.5]");
  EXPECT_EQ(quaternion.start, (std::vector<double>{0.5, 0.5, -0.5, 0.5}));
  EXPECT_EQ(JointOf("type: spherical, start: [0, 0, 0]").start,
            ZeroCoordinates(JointType::kSpherical));
}

TEST(Reader, TakesThePitchOfAScrewPerTurn) {
  const Joint screw = JointOf("type: screw, pitch: 5, start: 180", "length: mm, angle: deg");
  EXPECT_NEAR(screw.pitch * 2 * std::numbers::pi, 0.005, 0.005 * kRounding);
  EXPECT_NEAR(screw.start[0], std::numbers::pi, 4 * kRounding);
}

TEST(Reader, ConvertsEachFreedomByItsKind) {
  const Joint planar = JointOf(
      "type: planar, start: [10, 20, 30], limits: [[0, 100], null, [null, 90]],"
      " viscous: [1, 2, 3], coulomb: [4, 5, 6],"
      " spring: {stiffness: [7, 8, 9], rest: [1, 2, 3]}, friction: {coefficient: 0.1, radius: 4}",
      "length: mm, angle: deg, stiffness: N/mm, torque: N mm");
  EXPECT_NEAR(planar.start[1], 0.02, kRounding);
  EXPECT_NEAR(planar.start[2], 30 * kDegree, kRounding);
  EXPECT_NEAR(planar.upper[0], 0.1, kRounding);
  EXPECT_EQ(planar.lower[1], -std::numeric_limits<double>::infinity());
  EXPECT_EQ(planar.lower[2], -std::numeric_limits<double>::infinity());
  EXPECT_NEAR(planar.upper[2], 90 * kDegree, 2 * kRounding);
  EXPECT_EQ(planar.passive[1].viscous, 2);
  EXPECT_EQ(planar.passive[0].coulomb, 4);
  EXPECT_NEAR(planar.passive[2].coulomb, 0.006, kRounding);
  EXPECT_EQ(planar.passive[1].stiffness, 8000);
  EXPECT_EQ(planar.passive[2].stiffness, 9);
  EXPECT_NEAR(planar.passive[2].rest, 3 * kDegree, kRounding);
  EXPECT_NEAR(planar.load_friction.radius, 0.004, kRounding);
}

TEST(Reader, TakesValuesOfFreedomsByTheirNames) {
  const std::string units = "length: mm, angle: deg, stiffness: N/mm, torque: N mm";
  const Joint by_name = JointOf(
      "type: planar, start: {y: 20, rz: 30}, limits: {x: [0, 100], rz: [null, 90], y: null},"
      " viscous: {y: 2}, coulomb: {rz: 6}, spring: {stiffness: {rz: 9}, rest: {rz: 3}}",
      units);
  const Joint by_place = JointOf(
      "type: planar, start: [0, 20, 30], limits: [[0, 100], null, [null, 90]],"
      " viscous: [0, 2, 0], coulomb: [0, 0, 6], spring: {stiffness: [0, 0, 9], rest: [0, 0, 3]}",
      units);
  EXPECT_EQ(by_name.start, by_place.start);
  EXPECT_EQ(by_name.lower, by_place.lower);
  EXPECT_EQ(by_name.upper, by_place.upper);
  for (int k = 0; k < 3; ++k) {
    EXPECT_EQ(by_name.passive[k].stiffness, by_place.passive[k].stiffness);
    EXPECT_EQ(by_name.passive[k].rest, by_place.passive[k].rest);
    EXPECT_EQ(by_name.passive[k].viscous, by_place.passive[k].viscous);
    EXPECT_EQ(by_name.passive[k].coulomb, by_place.passive[k].coulomb);
  }
  EXPECT_EQ(JointOf("type: revolute, start: {rz: 40}", units).start,
            JointOf("type: revolute, start: 40", units).start);
}

TEST(Reader, TakesTheLengthsOfFrictionThatATypeHas) {
  const LoadFriction pin =
      JointOf(
          "type: revolute, friction: {coefficient: 0.1, radius: 4, thrust_radius: 6, length: 8}",
          "length: mm")
          .load_friction;
  EXPECT_NEAR(pin.thrust_radius, 0.006, kRounding);
  EXPECT_NEAR(pin.length, 0.008, kRounding);
  const LoadFriction slide =
      JointOf("type: prismatic, friction: {coefficient: 0.1, length: 80, width: 20}", "length: mm")
          .load_friction;
  EXPECT_NEAR(slide.length, 0.08, kRounding);
  EXPECT_NEAR(slide.width, 0.02, kRounding);
}

TEST(Reader, MakesTheXAxisSquareToTheZAxis) {
  const Mechanism mechanism = Parse("x-note: {z: 1}", "type: weld");
  EXPECT_TRUE(mechanism.anchor(mechanism.joints[0].first).X_LA.R.isIdentity(0));
  const Mechanism oblique = ParseMechanism(
      "{vmech: \"1.0\", gravity: [0, 0, 0], ground: a, links: {a: {anchors: "
      "{f: {z: [0, 0, 3], x: [2, 0, 2]}}}}, joints: {}}",
      "oblique.yaml");
  EXPECT_TRUE(oblique.links[0].anchors[0].X_LA.R.isApprox(Matrix3d::Identity(), kRounding));
}

TEST(Reader, ReadsEveryExample) {
  int count = 0;
  for (const auto& file : std::filesystem::directory_iterator(VMECH_EXAMPLES)) {
    const std::string text = file.path().extension() == ".yaml" ? ReadTextFile(file.path()) : "";
    if (text.find("\nvmech: ") == text.npos) continue;
    EXPECT_NO_THROW(ReadMechanism(file.path())) << file.path();
    ++count;
  }
  EXPECT_GE(count, 13);
}

TEST(Reader, NamesAMechanismAfterItsFileIfItHasNoName) {
  EXPECT_EQ(Parse("mass: 1", "type: weld").name, "body");
}

}  // namespace
}  // namespace vmech::reader_test
