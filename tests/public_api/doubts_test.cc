#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <functional>
#include <numbers>

#include "support/examples.h"
#include "vmech/dynamics/loads/run_load_study.h"
#include "vmech/dynamics/loads/study_plausibility.h"
#include "vmech/kinematics/motion/table_roughness.h"
#include "vmech/mechanisms/plausibility.h"

namespace vmech {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr double kDegree = std::numbers::pi / 180;

/// A turn of the slider-crank in 72 steps.
LoadStudy Turn() {
  LoadStudy study;
  study.mechanism = Example("slider-crank");
  study.drives = {{FindJoint(study.mechanism, "main"), 0, MotionLaw::Uniform(0, 10)}};
  constexpr int kSteps = 72;
  study.cycle = 2 * std::numbers::pi / 10;
  for (int i = 0; i < kSteps; ++i) study.times.push_back(study.cycle * i / kSteps);
  return study;
}

std::vector<std::string> DoubtsOf(const std::function<void(LoadStudy*)>& spoil) {
  LoadStudy study = Turn();
  spoil(&study);
  return RunLoadStudy(study).warnings;
}

Link& Coupler(LoadStudy* study) {
  return study->mechanism.links[FindLink(study->mechanism, "coupler")];
}

TEST(Doubts, ExamplesRaiseNone) {
  for (const std::string& name : ExampleNames()) {
    EXPECT_THAT(vmech::DoubtsOf(Example(name)), IsEmpty()) << name;
  }
  EXPECT_THAT(RunLoadStudy(Turn()).warnings, IsEmpty());
}

TEST(Doubts, InertiaInTheWrongUnit) {
  // kg mm^2 taken for kg m^2: the radius of gyration is a thousand times too large.
  const auto large = [](LoadStudy* study) { Coupler(study).mass_properties.I_Lcm *= 1e6; };
  LoadStudy study = Turn();
  const MassProperties& coupler = Coupler(&study).mass_properties;
  const double radius =
      1e3 * std::sqrt(coupler.I_Lcm.eigenvalues().real().maxCoeff() / coupler.mass);
  EXPECT_THAT(
      DoubtsOf(large),
      ElementsAre(AllOf(HasSubstr("link 'coupler'"), HasSubstr("radius of gyration"),
                        HasSubstr(fmt::format("{:.4g} mm", 1e3 * radius)), HasSubstr("units"))));
  const auto small = [](LoadStudy* study) { Coupler(study).mass_properties.I_Lcm *= 1e-6; };
  EXPECT_THAT(DoubtsOf(small), ElementsAre(HasSubstr("radius of gyration")));
  const auto point = [](LoadStudy* study) { Coupler(study).mass_properties.I_Lcm.setZero(); };
  EXPECT_THAT(DoubtsOf(point), IsEmpty());
}

TEST(Doubts, MillimetresTakenForMetres) {
  Mechanism mechanism = Example("slider-crank");
  for (Link& link : mechanism.links) {
    for (Anchor& anchor : link.anchors) anchor.X_LA.p *= 1000;
    link.mass_properties.p_LoLcm *= 1000;
    link.mass_properties.I_Lcm *= 1e6;
  }
  EXPECT_THAT(
      vmech::DoubtsOf(mechanism),
      testing::Contains(AllOf(HasSubstr("longest link, 'coupler'"), HasSubstr("150 m long"))));
}

TEST(Doubts, GravityInMillimetres) {
  const auto spoil = [](LoadStudy* study) { study->mechanism.gravity_W = {0, 0, -9810}; };
  EXPECT_THAT(DoubtsOf(spoil), ElementsAre(AllOf(HasSubstr("gravity is 9810 m/s^2"))));
  const auto moon = [](LoadStudy* study) { study->mechanism.gravity_W = {0, 0, -1.62}; };
  EXPECT_THAT(DoubtsOf(moon), IsEmpty());
}

TEST(Doubts, NoMassAtAll) {
  const auto spoil = [](LoadStudy* study) {
    for (Link& link : study->mechanism.links) link.mass_properties = {};
  };
  EXPECT_THAT(DoubtsOf(spoil), ElementsAre(HasSubstr("no link that moves has a mass")));
  const auto pushed = [&](LoadStudy* study) {
    spoil(study);
    ExternalLoad push;
    push.link = FindLink(study->mechanism, "slider");
    push.at = {0};
    push.wrenches = {{{10, 0, 0}, {0, 0, 0}}};
    study->external = {push};
  };
  EXPECT_THAT(DoubtsOf(pushed), IsEmpty());
}

TEST(Doubts, DegreesTakenForRadians) {
  Mechanism mechanism = Example("crank");
  mechanism.joints[0].start = {59.41};
  mechanism.units = {"mm", "deg", 1e-3, kDegree};
  EXPECT_THAT(vmech::DoubtsOf(mechanism),
              ElementsAre(AllOf(HasSubstr("starts at 3403.94 deg"), HasSubstr("9.46 turns"))));
}

TEST(Doubts, DensityInGramsPerCubicCentimetre) {
  EXPECT_THAT(DoubtsOfDensity("part 'rod'", 7.85),
              ElementsAre(AllOf(HasSubstr("part 'rod'"), HasSubstr("7.85 kg/m^3"))));
  EXPECT_THAT(DoubtsOfDensity("part 'rod'", 7.85e6), testing::SizeIs(1));
  EXPECT_THAT(DoubtsOfDensity("part 'rod'", 7850), IsEmpty());
}

TEST(Doubts, FewPosesInACycle) {
  const auto spoil = [](LoadStudy* study) { study->times.resize(8); };
  EXPECT_THAT(DoubtsOf(spoil), ElementsAre(HasSubstr("8 poses in a cycle")));
}

/// Two hinges in line and a third joint that carries on: the link behind them is locked to the
/// frame by a second strut, while the drive turns a link of its own.
TEST(Doubts, ALinkThatStandsStill) {
  const auto spoil = [](LoadStudy* study) {
    Mechanism& m = study->mechanism;
    const int lever = static_cast<int>(m.links.size());
    Link link{"lever", {1, {0.05, 0, 0}, 1e-3 * Matrix3d::Identity()}, {}};
    const Matrix3d across = AxesFromZX({1, 0, 0}, {0, 1, 0});
    link.anchors = {{"one", {}}, {"two", {across, {0.1, 0, 0}}}};
    m.links.push_back(link);
    std::vector<Anchor>& frame = m.links[m.ground].anchors;
    const int count = static_cast<int>(frame.size());
    frame.push_back({"one", {Matrix3d::Identity(), {0, 0, 0.5}}});
    frame.push_back({"two", {across, {0.1, 0, 0.5}}});
    m.joints.push_back(MakeJoint("one", JointType::kRevolute, {m.ground, count}, {lever, 0}));
    m.joints.push_back(MakeJoint("two", JointType::kRevolute, {m.ground, count + 1}, {lever, 1}));
  };
  EXPECT_THAT(DoubtsOf(spoil), ElementsAre(AllOf(HasSubstr("'lever'"), HasSubstr("vmech check"))));
}

/// The crank's swing, its angles rounded to `digit`, a row every millisecond.
std::vector<std::string> DoubtsOfRounded(double digit) {
  std::vector<double> times, angles;
  for (int i = 0; i < 500; ++i) {
    times.push_back(1e-3 * i);
    angles.push_back(digit * std::round(std::sin(4 * std::numbers::pi * times.back()) / digit));
  }
  return DoubtsOf([&](LoadStudy* study) {
    study->drives[0].law = MotionLaw::Table(times, angles);
    study->times = times;
    study->cycle = 0;
  });
}

TEST(Doubts, AccelerationsThatAreRounding) {
  EXPECT_THAT(DoubtsOfRounded(1e-4),
              ElementsAre(AllOf(HasSubstr("drive at 'main'"), HasSubstr("mostly rounding"))));
  EXPECT_THAT(DoubtsOfRounded(1e-6), IsEmpty());
}

TEST(TableRoughness, OfRoundingIsThatOfItsVariance) {
  // Rounding to a digit d scatters by d / 12^1/2; second differences multiply it by 6^1/2 / h^2.
  constexpr double kDigit = 1e-3, kStep = 1e-2;
  std::vector<double> times, values;
  for (int i = 0; i < 5000; ++i) {
    times.push_back(kStep * i);
    values.push_back(kDigit * std::round(std::sin(3 * times.back()) / kDigit));
  }
  const TableRoughness roughness = FindRoughness(times, values);
  EXPECT_NEAR(roughness.noise, kDigit / std::sqrt(12.0) * std::sqrt(6.0) / (kStep * kStep), 0.2);
  EXPECT_GT(roughness.acceleration, 9 / std::numbers::sqrt2);
}

TEST(TableRoughness, OfACubicIsNone) {
  std::vector<double> times{0, 0.1, 0.3, 0.35, 0.6, 0.8, 0.85, 1, 1.3}, values;
  for (double t : times) values.push_back(t * t * t - 2 * t);
  const TableRoughness roughness = FindRoughness(times, values);
  EXPECT_LT(roughness.noise, 1e-12);
  EXPECT_GT(roughness.acceleration, 1);
}

}  // namespace
}  // namespace vmech
