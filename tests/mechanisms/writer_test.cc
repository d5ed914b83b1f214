#include "vmech/mechanisms/files/writer.h"

#include <gtest/gtest.h>

#include <limits>
#include <numbers>
#include <sstream>
#include <stdexcept>

#include "same_mechanism.h"
#include "support/examples.h"
#include "vmech/mechanisms/files/reader.h"
#include "vmech/mechanisms/freedoms.h"
#include "vmech/mechanisms/mass_properties.h"

namespace vmech::writer_test {
namespace {

constexpr double kSameBits = 0;
constexpr double kTurn = 2 * std::numbers::pi;
constexpr double kTwoRoundings = 1e-15;  // relative: a figure in SI that no decimal in mm gives

Mechanism Rewritten(const Mechanism& mechanism, FileUnits units) {
  return ParseMechanism(WriteMechanism(mechanism, {units, ""}), "written.yaml");
}

class WriterOfExample : public testing::TestWithParam<std::string> {};

TEST_P(WriterOfExample, GivesTheSameBitsInMetresAndRadians) {
  const Mechanism mechanism = Example(GetParam());
  ExpectSame(mechanism, Rewritten(mechanism, FileUnits::kMetresRadians), kSameBits);
}

TEST_P(WriterOfExample, GivesTheSameFiguresInMillimetresAndDegrees) {
  const Mechanism mechanism = Example(GetParam());
  ExpectSame(mechanism, Rewritten(mechanism, FileUnits::kMillimetresDegrees), kTwoRoundings);
}

TEST_P(WriterOfExample, RepeatsItselfToTheLetter) {
  const std::string text = WriteMechanism(Example(GetParam()));
  EXPECT_EQ(WriteMechanism(ParseMechanism(text, "written.yaml")), text);
}

TEST_P(WriterOfExample, KeepsWithinAHundredColumns) {
  std::istringstream lines(
      WriteMechanism(Example(GetParam()), {FileUnits::kMillimetresDegrees, ""}));
  for (std::string line; std::getline(lines, line);) EXPECT_LE(line.size(), 100u) << line;
}

INSTANTIATE_TEST_SUITE_P(All, WriterOfExample, testing::ValuesIn(ExampleNames()),
                         [](const auto& info) { return TestName(info.param); });

constexpr JointType kTypes[] = {
    JointType::kRevolute,  JointType::kPrismatic, JointType::kCylindrical, JointType::kScrew,
    JointType::kUniversal, JointType::kSpherical, JointType::kPlanar,      JointType::kWeld};

Posed RandomPose(Random* random) {
  return {AxesFromZX(random->Vector(3), random->Vector(3)), random->Vector(3)};
}

/// A joint that has everything its type may have.
Joint RandomJoint(const std::string& name, JointType type, AnchorId first, AnchorId second,
                  Random* random) {
  Joint joint = MakeJoint(name, type, first, second);
  if (type == JointType::kScrew) joint.pitch = random->Between(-0.1, -0.01) / kTurn;
  for (double& value : joint.start) value = random->Between(-1, 1);
  if (type == JointType::kSpherical) {
    Eigen::Map<Eigen::Vector4d>(joint.start.data()).normalize();
  } else if (!joint.lower.empty()) {
    joint.lower[0] = -random->Between(1, 2);
    joint.upper.back() = random->Between(1, 2);
    for (Passive& passive : joint.passive) {
      passive = {random->Between(0, 5), random->Between(-1, 1), 0.2, random->Between(0, 3)};
    }
  }
  if (type != JointType::kWeld) joint.load_friction.coefficient = random->Between(0, 1);
  const FrictionKeys used = FrictionKeysOf(type);
  if (used.radius) joint.load_friction.radius = random->Between(0.01, 0.02);
  if (used.thrust_radius) joint.load_friction.thrust_radius = random->Between(0.02, 0.03);
  if (used.length) joint.load_friction.length = random->Between(0.1, 0.2);
  if (used.width) joint.load_friction.width = random->Between(0.03, 0.05);
  joint.stiffness = Vector6d::Constant(random->Between(1e6, 1e9));
  return joint;
}

/// A chain with a joint of every type, and odd figures and names everywhere.
Mechanism RandomMechanism(unsigned seed) {
  Random random(seed);
  Mechanism mechanism;
  mechanism.name = "true: \"odd\" \\ name\n";
  mechanism.gravity_W = random.Vector(3, 10);
  mechanism.links.push_back({"0 ground", {}, {{"a: {", RandomPose(&random)}}});
  for (const JointType type : kTypes) {
    const int i = static_cast<int>(mechanism.links.size());
    const Matrix3d R = RandomPose(&random).R;
    const Vector3d moments = Vector3d::Constant(3) + random.Vector(3);
    mechanism.links.push_back(
        {"link #" + std::to_string(i),
         {random.Between(1, 2), random.Vector(3), RotatedInertia(R, moments.asDiagonal())},
         {{"null", RandomPose(&random)}, {"é - ü", RandomPose(&random)}}});
    mechanism.joints.push_back(
        RandomJoint("j'" + std::to_string(i), type, {i - 1, i == 1 ? 0 : 1}, {i, 0}, &random));
  }
  mechanism.grasps.push_back({"no", 3, RandomPose(&random), GraspKind::kPoint});
  mechanism.preferred_cuts = {2, 0};
  return mechanism;
}

TEST(Writer, GivesTheSameBitsForOddFiguresAndNames) {
  for (unsigned seed = 0; seed < 200; ++seed) {
    const Mechanism mechanism = RandomMechanism(seed);
    ExpectSame(mechanism, Rewritten(mechanism, FileUnits::kMetresRadians), kSameBits);
    ExpectSame(mechanism, Rewritten(mechanism, FileUnits::kMillimetresDegrees), kTwoRoundings);
  }
}

TEST(Writer, GivesBackTheDecimalsThatPeopleWrote) {
  const std::string text =
      WriteMechanism(Example("slider-crank"), {FileUnits::kMillimetresDegrees, "A crank.\n\nOwn."});
  EXPECT_EQ(text.substr(0, text.find("  coupler:")), R"(# A crank.
#
# Own.
vmech: "1.0"
name: slider-crank
units: {length: mm, angle: deg}
gravity: [0, -9.81, 0]
ground: frame
links:
  frame:
    anchors:
      main:  {}
      guide: {z: [1, 0, 0], x: [0, 1, 0]}
  crank:
    mass: 0.4
    center_of_gravity: [25, 0, 0]
    inertia: {xx: 10, yy: 100, zz: 110}
    anchors:
      main: {}
      pin:  {origin: [50, 0, 0]}
)");
  EXPECT_NE(text.find("  main:  {type: revolute, connects: [frame/main, crank/main], start: 40}\n"),
            std::string::npos);
}

TEST(Writer, KeepsAnInertiaThatIsRightOnlyAboutTheOrigin) {
  Mechanism mechanism = Example("crank");
  MassProperties& crank = mechanism.links[1].mass_properties;
  crank = {2, {3, 0, 0}, Matrix3d(Vector3d(-1e-6, 0.01, 0.01).asDiagonal())};  // 18 kg m^2 there
  const Mechanism again = Rewritten(mechanism, FileUnits::kMetresRadians);
  EXPECT_TRUE(again.links[1].mass_properties.I_Lcm.isApprox(crank.I_Lcm, 1e-12));
}

TEST(Writer, RefusesAFigureThatIsNotFinite) {
  Mechanism mechanism = Example("crank");
  mechanism.gravity_W.x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(WriteMechanism(mechanism), std::invalid_argument);
}

}  // namespace
}  // namespace vmech::writer_test
