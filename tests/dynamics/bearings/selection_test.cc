#include "vmech/dynamics/bearings/selection.h"

#include <gtest/gtest.h>

#include <numbers>
#include <random>

#include "vmech/dynamics/bearings/catalogue.h"

namespace vmech {
namespace {

constexpr double kRpm = std::numbers::pi / 30;

RotationSummary Steady(double rpm) {
  RotationSummary rotation;
  rotation.rotation = Rotation::kTurning;
  rotation.mean_speed = rotation.peak_speed = rpm * kRpm;
  rotation.revolutions_of_pose = {1};
  return rotation;
}

BearingSelection Select(double radial, double axial, double rpm,
                        const BearingRequirements& requirements) {
  const std::vector<BearingForce> forces{{{radial, 0, axial}}};
  return SelectBearing(BuiltInCatalogue(), forces, Steady(rpm), requirements);
}

/// The choice in the order of size; behind the last bearing if none fits.
int Choice(double radial, double axial, double rpm, const BearingRequirements& requirements) {
  const BearingSelection selection = Select(radial, axial, rpm, requirements);
  return selection.chosen >= 0 ? selection.chosen : static_cast<int>(selection.candidates.size());
}

// NSK rolling bearings, example 2: 3 kN, 1900 rpm, 10 000 h, shaft 50 mm: 6210 (not 6010).
TEST(SelectBearing, ChoosesAsNskExample2) {
  BearingRequirements requirements;
  requirements.shaft_min = requirements.shaft_max = 0.050;
  requirements.housing_max = 0.100;
  const BearingSelection selection = Select(3000, 0, 1900, requirements);
  ASSERT_GE(selection.chosen, 0);
  EXPECT_EQ(selection.best()->bearing.designation, "6210");
}

TEST(SelectBearing, GivesAReasonAgainstEveryOtherBearing) {
  BearingRequirements requirements;
  requirements.shaft_min = 0.015;
  requirements.shaft_max = 0.030;
  const BearingSelection selection = Select(1500, 100, 1500, requirements);
  ASSERT_GE(selection.chosen, 0);
  EXPECT_TRUE(selection.ReasonAgainst(selection.chosen).empty());
  for (int i = 0; i < static_cast<int>(selection.candidates.size()); ++i) {
    if (i == selection.chosen) continue;
    EXPECT_FALSE(selection.ReasonAgainst(i).empty());
    EXPECT_TRUE(i > selection.chosen || !selection.candidates[i].fits());
  }
}

TEST(SelectBearing, NeverChoosesASmallerBearingForMore) {
  std::mt19937 generator(11);
  std::uniform_real_distribution<double> uniform(0, 1);
  for (int i = 0; i < 200; ++i) {
    const double Fr = 6000 * uniform(generator), Fa = 3000 * uniform(generator);
    const double rpm = 100 + 8000 * uniform(generator);
    const BearingRequirements base;
    const int choice = Choice(Fr, Fa, rpm, base);
    EXPECT_GE(Choice(Fr * 1.3, Fa, rpm, base), choice);
    EXPECT_GE(Choice(Fr, Fa * 1.3, rpm, base), choice);
    EXPECT_GE(Choice(Fr, Fa, rpm * 1.3, base), choice);
    BearingRequirements more = base;
    more.life_hours *= 2;
    EXPECT_GE(Choice(Fr, Fa, rpm, more), choice);
    more.reliability = 99;
    EXPECT_GE(Choice(Fr, Fa, rpm, more), choice);
    more = base;
    more.static_safety = 3;
    EXPECT_GE(Choice(Fr, Fa, rpm, more), choice);
    more = base;
    more.shaft_min = 0.02;
    EXPECT_GE(Choice(Fr, Fa, rpm, more), choice);
  }
}

TEST(SelectBearing, DoesNotDependOnTheOrderOfTheCatalogue) {
  std::vector<Bearing> reversed(BuiltInCatalogue().rbegin(), BuiltInCatalogue().rend());
  const std::vector<BearingForce> forces{{{1500, 0, 200}}};
  const BearingSelection there = SelectBearing(BuiltInCatalogue(), forces, Steady(1000), {});
  const BearingSelection back = SelectBearing(reversed, forces, Steady(1000), {});
  EXPECT_EQ(there.best()->bearing.designation, back.best()->bearing.designation);
}

TEST(SelectBearing, SaysWhatCameClosestIfNoneFits) {
  BearingRequirements requirements;
  requirements.shaft_max = 0.020;
  const BearingSelection selection = Select(2500, 0, 3000, requirements);
  EXPECT_EQ(selection.chosen, -1);
  ASSERT_GE(selection.closest, 0);
  EXPECT_EQ(selection.best()->bearing.designation, "6304");
  EXPECT_NE(selection.message.find("6304 comes closest: life"), std::string::npos)
      << selection.message;
  EXPECT_NE(selection.message.find("C of 30.4 kN"), std::string::npos) << selection.message;
}

TEST(SelectBearing, NamesTheNearestDimensionsIfNothingHasRoom) {
  BearingRequirements requirements;
  requirements.shaft_min = requirements.shaft_max = 0.031;
  const BearingSelection selection = Select(100, 0, 100, requirements);
  EXPECT_EQ(selection.chosen, -1);
  EXPECT_NE(selection.message.find("bore 30 mm, shaft at least 31 mm"), std::string::npos)
      << selection.message;
}

TEST(SelectBearing, OfAnEmptyCatalogueChoosesNothing) {
  const std::vector<BearingForce> forces{{{100, 0, 0}}};
  const BearingSelection selection = SelectBearing({}, forces, Steady(100), {});
  EXPECT_EQ(selection.best(), nullptr);
  EXPECT_EQ(selection.message, "the catalogue is empty");
}

}  // namespace
}  // namespace vmech
