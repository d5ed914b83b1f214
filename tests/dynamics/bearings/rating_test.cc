#include "vmech/dynamics/bearings/rating.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

namespace vmech {
namespace {

constexpr double kRpm = std::numbers::pi / 30;

// 6208 with the ratings of NTN's catalogue.
Bearing Ntn6208() {
  Bearing b;
  b.designation = "6208";
  b.bore = 0.040;
  b.outer_diameter = 0.080;
  b.width = 0.018;
  b.dynamic_rating = 32500;
  b.static_rating = 17800;
  b.f0 = 14.0;
  b.speed_grease = 8300 * kRpm;
  b.speed_oil = 10000 * kRpm;
  b.axial_limit = 0.5;
  return b;
}

RotationSummary Steady(double speed, size_t poses) {
  RotationSummary rotation;
  rotation.rotation = Rotation::kTurning;
  rotation.mean_speed = rotation.peak_speed = speed;
  rotation.revolutions_of_pose.assign(poses, 1.0);
  return rotation;
}

bool Has(const std::vector<Shortfall>& shortfalls, Criterion criterion) {
  return std::any_of(shortfalls.begin(), shortfalls.end(),
                     [&](const Shortfall& s) { return s.criterion == criterion; });
}

std::vector<Shortfall> ShortfallsUnder(const Bearing& bearing, const Vector3d& force, double speed,
                                       const BearingRequirements& requirements) {
  const std::vector<BearingForce> forces{{force}};
  const RotationSummary rotation = Steady(speed, 1);
  const BearingRating rating = RateBearing(bearing, forces, rotation, requirements.reliability);
  return LoadShortfalls(bearing, rating, rotation, requirements);
}

// NTN general catalogue, example 1: 3.2 kN, 650 rpm, "about 27 000 h".
TEST(RateBearing, GivesTheLifeOfNtnExample1) {
  const std::vector<BearingForce> forces(4, BearingForce{{0, 3200, 0}});
  const BearingRating rating = RateBearing(Ntn6208(), forces, Steady(650 * kRpm, 4), 90);
  EXPECT_NEAR(rating.life_hours, 26861.826578776043, 1e-6);
  EXPECT_EQ(rating.modified_life_hours, rating.life_hours);
  EXPECT_DOUBLE_EQ(rating.mean_load, 3200);
  EXPECT_DOUBLE_EQ(rating.static_safety, 17800.0 / 3200);
}

TEST(RateBearing, ShortensTheLifeByReliability) {
  const std::vector<BearingForce> forces(4, BearingForce{{0, 3200, 0}});
  const BearingRating rating = RateBearing(Ntn6208(), forces, Steady(650 * kRpm, 4), 98);
  EXPECT_DOUBLE_EQ(rating.modified_life_hours, 0.37 * rating.life_hours);
}

TEST(RateBearing, CountsAPoseAtRestForStaticSafetyOnly) {
  RotationSummary rotation = Steady(650 * kRpm, 2);
  rotation.revolutions_of_pose[1] = 0;
  const std::vector<BearingForce> forces{{{0, 3200, 0}}, {{8900, 0, 0}}};
  const BearingRating rating = RateBearing(Ntn6208(), forces, rotation, 90);
  EXPECT_DOUBLE_EQ(rating.mean_load, 3200);
  EXPECT_DOUBLE_EQ(rating.static_safety, 2);
}

TEST(RateBearing, OfAStandingJointHasNoEndOfLife) {
  RotationSummary rotation;
  rotation.revolutions_of_pose = {0};
  const std::vector<BearingForce> forces{{{0, 8900, 0}}};
  const BearingRating rating = RateBearing(Ntn6208(), forces, rotation, 90);
  EXPECT_TRUE(std::isinf(rating.modified_life_hours));
  EXPECT_DOUBLE_EQ(rating.static_safety, 2);
  EXPECT_TRUE(LoadShortfalls(Ntn6208(), rating, rotation, {}).empty());
}

TEST(LoadShortfalls, NameEachCriterionThatFails) {
  const Bearing b = Ntn6208();
  const double speed = 650 * kRpm;
  EXPECT_TRUE(ShortfallsUnder(b, {3200, 0, 0}, speed, {}).empty());
  EXPECT_TRUE(Has(ShortfallsUnder(b, {6000, 0, 0}, speed, {}), Criterion::kLife));
  EXPECT_TRUE(Has(ShortfallsUnder(b, {18000, 0, 0}, speed, {}), Criterion::kStaticSafety));
  EXPECT_TRUE(Has(ShortfallsUnder(b, {16500, 0, 0}, speed, {}), Criterion::kValidity));
  EXPECT_TRUE(Has(ShortfallsUnder(b, {100, 0, 0}, 8400 * kRpm, {}), Criterion::kSpeed));
  EXPECT_TRUE(Has(ShortfallsUnder(b, {0, 0, -9000}, speed, {}), Criterion::kAxialLoad));
}

TEST(LoadShortfalls, TakeTheLimitingSpeedOfTheLubricant) {
  BearingRequirements requirements;
  requirements.lubrication = Lubrication::kOil;
  EXPECT_TRUE(ShortfallsUnder(Ntn6208(), {400, 0, 0}, 8400 * kRpm, requirements).empty());
}

TEST(LoadShortfalls, RefuseAnyAxialLoadOnACylindricalRollerBearing) {
  Bearing roller = Ntn6208();
  roller.kind = BearingKind::kCylindricalRoller;
  EXPECT_TRUE(ShortfallsUnder(roller, {1000, 0, 0}, 60, {}).empty());
  EXPECT_TRUE(ShortfallsUnder(roller, {1000, 0, 1e-12}, 60, {}).empty());
  EXPECT_TRUE(Has(ShortfallsUnder(roller, {1000, 0, 5}, 60, {}), Criterion::kAxialLoad));
}

TEST(LoadShortfalls, SayWhatThereIsAndWhatIsAsked) {
  BearingRequirements requirements;
  requirements.life_hours = 100000;
  const std::vector<Shortfall> s =
      ShortfallsUnder(Ntn6208(), {3200, 0, 0}, 650 * kRpm, requirements);
  ASSERT_EQ(s.size(), 1u);
  EXPECT_EQ(s[0].text, "life 26\u202f900 h of 100\u202f000 h");
  EXPECT_NEAR(s[0].ratio, 0.2686, 1e-4);
}

TEST(DimensionShortfalls, TakeLimitsAsInclusive) {
  BearingRequirements requirements;
  requirements.shaft_min = requirements.shaft_max = 40 * 0.001;
  requirements.housing_max = 80 * 0.001;
  EXPECT_TRUE(DimensionShortfalls(Ntn6208(), requirements).empty());
  requirements.shaft_min = requirements.shaft_max = 0.041;
  requirements.housing_max = 0.079;
  const std::vector<Shortfall> s = DimensionShortfalls(Ntn6208(), requirements);
  EXPECT_TRUE(Has(s, Criterion::kShaft));
  EXPECT_TRUE(Has(s, Criterion::kHousing));
}

TEST(RatingWarnings, NameMinimumLoadAndSmallOscillation) {
  RotationSummary rotation = Steady(10, 1);
  rotation.rotation = Rotation::kOscillating;
  rotation.amplitude = 9.9 * std::numbers::pi / 180;
  const std::vector<BearingForce> light{{{300, 0, 0}}}, heavy{{{400, 0, 0}}};
  const auto count = [&](const std::vector<BearingForce>& forces) {
    return RatingWarnings(Ntn6208(), RateBearing(Ntn6208(), forces, rotation, 90), rotation, {})
        .size();
  };
  EXPECT_EQ(count(light), 2u);  // 0.01 C = 325 N
  EXPECT_EQ(count(heavy), 1u);
  rotation.amplitude = 10.1 * std::numbers::pi / 180;
  EXPECT_EQ(count(heavy), 0u);
}

TEST(BearingRequirements, RefuseValuesOutOfRangeByName) {
  const auto message = [](auto change) -> std::string {
    BearingRequirements requirements;
    change(requirements);
    try {
      requirements.Validate();
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "accepted";
  };
  using R = BearingRequirements;
  EXPECT_EQ(message([](R&) {}), "accepted");
  EXPECT_NE(message([](R& r) { r.shaft_min = -1; }).find("shaft_min"), std::string::npos);
  EXPECT_NE(message([](R& r) { r.shaft_min = 2, r.shaft_max = 1; }).find("shaft_max"),
            std::string::npos);
  EXPECT_NE(message([](R& r) { r.housing_max = 0; }).find("housing_max"), std::string::npos);
  EXPECT_NE(message([](R& r) { r.life_hours = NAN; }).find("life_hours"), std::string::npos);
  EXPECT_NE(message([](R& r) { r.static_safety = 0; }).find("static_safety"), std::string::npos);
  EXPECT_NE(message([](R& r) { r.reliability = 50; }).find("reliability"), std::string::npos);
}

TEST(FormatHours, KeepsThreeDigitsAndGroupsThousands) {
  EXPECT_EQ(FormatHours(26861.8), "26\u202F900 h");
  EXPECT_EQ(FormatHours(1234567), "1\u202F230\u202F000 h");
  EXPECT_EQ(FormatHours(42.4), "42 h");
  EXPECT_EQ(FormatHours(0), "0 h");
  EXPECT_EQ(FormatHours(INFINITY), "unlimited");
}

}  // namespace
}  // namespace vmech
