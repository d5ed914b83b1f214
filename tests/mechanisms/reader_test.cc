#include "vmech/mechanisms/reader.h"

#include <gtest/gtest.h>

#include <numbers>

#include "slider_crank.h"

namespace vmech {
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

}  // namespace
}  // namespace vmech
