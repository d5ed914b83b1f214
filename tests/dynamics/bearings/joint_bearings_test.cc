#include "vmech/dynamics/bearings/joint_bearings.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <stdexcept>

#include "vmech/dynamics/bearings/catalogue.h"

namespace vmech {
namespace {

constexpr double kPi = std::numbers::pi;

/// A shaft at 1500 rpm with a force that turns with it on a steady one, 20 mm beside the origin.
DutyCycle TurningShaft() {
  constexpr int kPoses = 360;
  constexpr double kSpeed = 50 * kPi;
  DutyCycle cycle;
  for (int i = 0; i < kPoses; ++i) {
    const double angle = 2 * kPi * i / kPoses;
    const Vector3d force(400 * std::cos(angle), 800 + 400 * std::sin(angle), 150);
    cycle.duration.push_back(2 * kPi / kSpeed / kPoses);
    cycle.angle.push_back(angle);
    cycle.speed.push_back(kSpeed);
    cycle.wrench.push_back({force, Vector3d(0, 0, 0.02).cross(force)});
  }
  return cycle;
}

BearingRequirements Shaft15To30() {
  BearingRequirements requirements;
  requirements.shaft_min = 0.015;
  requirements.shaft_max = 0.030;
  requirements.housing_max = 0.060;
  requirements.static_safety = 1.5;
  return requirements;
}

JointBearings Select(const Arrangement& arrangement, LoadCertainty certainty) {
  return SelectJointBearings(TurningShaft(), arrangement, Shaft15To30(), certainty,
                             BuiltInCatalogue());
}

TEST(SelectJointBearings, FillsBothPositionsAndRatesThemTogether) {
  const JointBearings joint = Select({{-0.015, 0.015}, 0}, LoadCertainty::kCertain);
  ASSERT_TRUE(joint.complete());
  ASSERT_EQ(joint.selections.size(), 2u);
  const double a = joint.selections[0].best()->rating->modified_life_hours;
  const double b = joint.selections[1].best()->rating->modified_life_hours;
  EXPECT_GE(std::min(a, b), Shaft15To30().life_hours);
  EXPECT_LT(joint.system_life_hours, std::min(a, b));
  const double e = 10.0 / 9;
  EXPECT_NEAR(std::pow(joint.system_life_hours, -e), std::pow(a, -e) + std::pow(b, -e), 1e-15);
}

/// Two bearings beside the origin of which each lives 10 000 h, and the pair as long as is asked.
JointBearings SelectPair(double pair_life, double housing) {
  BearingRequirements requirements = Shaft15To30();
  requirements.pair_life_hours = pair_life;
  requirements.housing_max = housing;
  return SelectJointBearings(TurningShaft(), {{-0.015, 0.015}, 0}, requirements,
                             LoadCertainty::kCertain, BuiltInCatalogue());
}

TEST(SelectJointBearings, TakesTheSmallestPairThatLivesAsLongAsIsAsked) {
  const JointBearings alone = SelectPair(0, 0.060);
  ASSERT_TRUE(alone.met());
  const double asked = 1.2 * alone.system_life_hours;
  const JointBearings pair = SelectPair(asked, 0.060);
  ASSERT_TRUE(pair.met()) << pair.BriefReport();
  EXPECT_GE(pair.system_life_hours, asked);
  EXPECT_TRUE(pair.warnings.empty());
  const auto size = [](const JointBearings& joint) {
    return joint.selections[0].best()->bearing.outer_diameter +
           joint.selections[1].best()->bearing.outer_diameter;
  };
  EXPECT_GT(size(pair), size(alone));
  // By hand: no other pair that fits and lives long enough is smaller.
  for (const Candidate& a : pair.selections[0].candidates) {
    for (const Candidate& b : pair.selections[1].candidates) {
      if (!a.fits() || !b.fits()) continue;
      const double e = 10.0 / 9, La = a.rating->modified_life_hours,
                   Lb = b.rating->modified_life_hours;
      if (std::pow(std::pow(La, -e) + std::pow(Lb, -e), -1 / e) < asked) continue;
      EXPECT_GE(a.bearing.outer_diameter + b.bearing.outer_diameter, size(pair) - 1e-12);
    }
  }
}

TEST(SelectJointBearings, AsksOfThePairWhatIsAskedOfEachUnlessItIsAskedItself) {
  BearingRequirements requirements = Shaft15To30();
  requirements.life_hours = 50000;
  const JointBearings joint =
      SelectJointBearings(TurningShaft(), {{-0.015, 0.015}, 0}, requirements,
                          LoadCertainty::kCertain, BuiltInCatalogue());
  EXPECT_EQ(joint.asked_system_life, 50000);
  EXPECT_EQ(joint.met(), joint.system_life_hours >= 50000);
  EXPECT_EQ(Select({{0.02}, 0}, LoadCertainty::kCertain).asked_system_life, 0);
}

TEST(SelectJointBearings, APairThatFallsShortIsNotMetAndSaysSo) {
  const JointBearings longest = SelectPair(1e7, 0.060);
  EXPECT_TRUE(longest.complete());
  EXPECT_FALSE(longest.met());
  ASSERT_EQ(longest.warnings.size(), 1u);
  EXPECT_NE(longest.warnings[0].find("10\u202F000\u202F000 h asked of them"), std::string::npos)
      << longest.warnings[0];
  EXPECT_NE(longest.BriefReport().find(" of 10\u202F000\u202F000 h"), std::string::npos);
  for (const BearingSelection& selection : longest.selections) {
    for (const Candidate& candidate : selection.candidates) {
      if (!candidate.fits()) continue;
      EXPECT_LE(candidate.rating->modified_life_hours,
                selection.best()->rating->modified_life_hours);
    }
  }
}

TEST(SelectJointBearings, GivesTheOverhungBearingTheGreaterLoad) {
  // The force acts at 20 mm: beyond the bearing at 15 mm, which carries 35/30 of it.
  const JointBearings joint = Select({{-0.015, 0.015}, 0}, LoadCertainty::kCertain);
  const double applied = 1200;  // at 90 degrees the two forces add up
  EXPECT_NEAR(joint.loads.forces[1][90].radial(), applied * 35 / 30, 1e-9);
  EXPECT_NEAR(joint.loads.forces[0][90].radial(), applied * 5 / 30, 1e-9);
  EXPECT_EQ(joint.loads.forces[0][90].axial(), 150);
  EXPECT_EQ(joint.loads.forces[1][90].axial(), 0);
}

TEST(SelectJointBearings, WarnsThatASingleBearingCannotTakeAMoment) {
  const JointBearings offset = Select({{0.0}, 0}, LoadCertainty::kCertain);
  EXPECT_NEAR(offset.peak_tilting_moment, 1200 * 0.02, 1e-9);
  ASSERT_EQ(offset.warnings.size(), 1u);
  EXPECT_NE(offset.warnings[0].find("24 N m"), std::string::npos) << offset.warnings[0];
  const JointBearings centred = Select({{0.02}, 0}, LoadCertainty::kCertain);
  EXPECT_TRUE(centred.warnings.empty());
}

TEST(SelectJointBearings, MarksWhatDependsOnTheRule) {
  const Arrangement arrangement{{-0.015, 0.015}, 0};
  const auto marked = [&](LoadCertainty certainty) {
    return Select(arrangement, certainty).BriefReport().find("depends on the chosen rule") !=
           std::string::npos;
  };
  EXPECT_TRUE(marked(LoadCertainty::kDependsOnRule));
  EXPECT_FALSE(marked(LoadCertainty::kCertain));
}

TEST(SelectJointBearings, HasNoSystemLifeWhileAPositionIsEmpty) {
  BearingRequirements requirements = Shaft15To30();
  requirements.life_hours = 1e7;
  const JointBearings joint =
      SelectJointBearings(TurningShaft(), {{-0.015, 0.015}, 0}, requirements,
                          LoadCertainty::kCertain, BuiltInCatalogue());
  EXPECT_FALSE(joint.complete());
  EXPECT_EQ(joint.system_life_hours, 0);
  EXPECT_NE(joint.BriefReport().find("comes closest"), std::string::npos);
}

TEST(SelectJointBearings, ReportsEveryBearingThatWasPassedOver) {
  const JointBearings joint = Select({{-0.015, 0.015}, 0}, LoadCertainty::kCertain);
  const std::string report = joint.FullReport();
  for (const Bearing& bearing : BuiltInCatalogue()) {
    EXPECT_NE(report.find(bearing.designation), std::string::npos) << bearing.designation;
  }
  EXPECT_NE(report.find("turns at 1500 rpm"), std::string::npos) << report;
}

TEST(SelectJointBearings, DoesNotDependOnTheUnitOfTheCycle) {
  // The same cycle run through twice has the same life.
  DutyCycle twice = TurningShaft();
  const DutyCycle once = twice;
  twice.duration.insert(twice.duration.end(), once.duration.begin(), once.duration.end());
  twice.angle.insert(twice.angle.end(), once.angle.begin(), once.angle.end());
  twice.speed.insert(twice.speed.end(), once.speed.begin(), once.speed.end());
  twice.wrench.insert(twice.wrench.end(), once.wrench.begin(), once.wrench.end());
  const Arrangement arrangement{{-0.015, 0.015}, 0};
  const auto life = [&](const DutyCycle& cycle) {
    return SelectJointBearings(cycle, arrangement, Shaft15To30(), LoadCertainty::kCertain,
                               BuiltInCatalogue())
        .system_life_hours;
  };
  EXPECT_NEAR(life(twice), life(once), 1e-9 * life(once));
}

/// A rocker that swings by +-amplitude, 600 times a minute, under a steady force.
DutyCycle Rocker(double amplitude) {
  constexpr int kPoses = 3600;
  DutyCycle cycle;
  for (int i = 0; i < kPoses; ++i) {
    const double phase = 2 * kPi * i / kPoses;
    cycle.duration.push_back(0.1 / kPoses);
    cycle.angle.push_back(amplitude * std::sin(phase));
    cycle.speed.push_back(20 * kPi * amplitude * std::cos(phase));
    cycle.wrench.push_back({{0, 1500, 0}, {0, 0, 0}});
  }
  return cycle;
}

// SKF 17000 EN: life in cycles = (180 / 2 gamma) L10.
TEST(SelectJointBearings, RatesARockerByTheRuleOfSkf) {
  constexpr double kGammaDegrees = 30, kCyclesPerHour = 36000;
  const JointBearings joint =
      SelectJointBearings(Rocker(kGammaDegrees * kPi / 180), {}, Shaft15To30(),
                          LoadCertainty::kCertain, BuiltInCatalogue());
  ASSERT_TRUE(joint.complete());
  EXPECT_EQ(joint.rotation.rotation, Rotation::kOscillating);
  const Candidate& choice = *joint.selections[0].best();
  const double L10 = std::pow(choice.bearing.dynamic_rating / 1500, 3);
  const double hours = 180 / (2 * kGammaDegrees) * L10 * 1e6 / kCyclesPerHour;
  EXPECT_NEAR(choice.rating->life_hours, hours, 1e-6 * hours);  // rectangle rule on |cos|
}

TEST(SelectJointBearings, WarnsOfASmallOscillation) {
  const JointBearings joint = SelectJointBearings(Rocker(5 * kPi / 180), {}, Shaft15To30(),
                                                  LoadCertainty::kCertain, BuiltInCatalogue());
  ASSERT_EQ(joint.selections[0].warnings.size(), 1u);
  EXPECT_NE(joint.selections[0].warnings[0].find("+-5 deg"), std::string::npos);
}

TEST(SelectJointBearings, RefusesABadCycle) {
  DutyCycle cycle = TurningShaft();
  cycle.angle.pop_back();
  EXPECT_THROW(SelectJointBearings(cycle, {}, {}, LoadCertainty::kCertain, BuiltInCatalogue()),
               std::invalid_argument);
}

}  // namespace
}  // namespace vmech
