#include "vmech/dynamics/bearings/duty_cycle.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

namespace vmech {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kRoundoff = 1e-12;

/// angle = offset + amplitude sin(2 pi t), t over one second, with exact speeds.
DutyCycle Oscillation(double amplitude, int poses) {
  DutyCycle cycle;
  for (int i = 0; i < poses; ++i) {
    const double phase = 2 * kPi * i / poses;
    cycle.duration.push_back(1.0 / poses);
    cycle.angle.push_back(0.3 + amplitude * std::sin(phase));
    cycle.speed.push_back(2 * kPi * amplitude * std::cos(phase));
    cycle.wrench.push_back({{0, 100, 0}, {0, 0, 0}});
  }
  return cycle;
}

DutyCycle ConstantSpeed(double speed, int poses) {
  DutyCycle cycle;
  for (int i = 0; i < poses; ++i) {
    cycle.duration.push_back(1.0 / poses);
    cycle.angle.push_back(speed * i / poses);
    cycle.speed.push_back(speed);
    cycle.wrench.push_back({{0, 100, 0}, {0, 0, 0}});
  }
  return cycle;
}

TEST(SummariseRotation, CountsTurnsOfASteadyShaft) {
  const RotationSummary summary = SummariseRotation(ConstantSpeed(-50 * kPi, 100));
  EXPECT_EQ(summary.rotation, Rotation::kTurning);
  EXPECT_NEAR(summary.revolutions, 25, 25 * kRoundoff);
  EXPECT_NEAR(summary.mean_speed, 50 * kPi, 1e3 * kRoundoff);
  EXPECT_NEAR(summary.peak_speed, 50 * kPi, kRoundoff);
}

// SKF: cycles = (180 / 2 gamma) L10, so that a cycle is as harmful as 2 gamma / 180 turns.
// FAG: n = n_osc phi / 180 with the swept angle phi = 2 gamma. Both are the path over 2 pi.
TEST(SummariseRotation, AgreesWithTheOscillationFactorOfSkfAndFag) {
  constexpr double kGammaDegrees = 25;
  // |cos| has kinks, the rectangle rule over 4000 poses leaves (2 pi / 4000)^2 / 6.
  constexpr double kQuadrature = 1e-6;
  const RotationSummary summary = SummariseRotation(Oscillation(kGammaDegrees * kPi / 180, 4000));
  EXPECT_EQ(summary.rotation, Rotation::kOscillating);
  EXPECT_NEAR(summary.amplitude * 180 / kPi, kGammaDegrees, 1e-9);
  EXPECT_NEAR(summary.revolutions, 2 * kGammaDegrees / 180, kQuadrature);
}

TEST(SummariseRotation, TellsReversingFromOscillating) {
  EXPECT_EQ(SummariseRotation(Oscillation(3, 400)).rotation, Rotation::kOscillating);
  EXPECT_EQ(SummariseRotation(Oscillation(4, 400)).rotation, Rotation::kReversing);
}

TEST(SummariseRotation, TakesRoundoffForStandingStillAndNotForReversal) {
  EXPECT_EQ(SummariseRotation(ConstantSpeed(1e-14, 10)).rotation, Rotation::kStanding);
  DutyCycle cycle = ConstantSpeed(1, 10);
  cycle.speed[3] = -1e-13;
  EXPECT_EQ(SummariseRotation(cycle).rotation, Rotation::kTurning);
}

TEST(DurationsFromTimes, AddUpToTheTimeCovered) {
  const std::vector<double> times{0, 1, 3, 4};
  EXPECT_EQ(DurationsFromTimes(times), (std::vector<double>{0.5, 1.5, 1.5, 0.5}));
  EXPECT_EQ(DurationsFromTimes(std::vector<double>{7}), (std::vector<double>{1}));
  EXPECT_THROW(DurationsFromTimes(std::vector<double>{0, 0}), std::invalid_argument);
  // A cycle of 6 s: the first pose follows the last by 2 s.
  EXPECT_EQ(DurationsFromTimes(times, 6), (std::vector<double>{1.5, 1.5, 1.5, 1.5}));
  EXPECT_EQ(DurationsFromTimes(std::vector<double>{7}, 3), (std::vector<double>{3}));
  EXPECT_EQ(DurationsFromTimes(times, 4), DurationsFromTimes(times));
}

TEST(DutyCycle, RefusesWhatIsNotACycle) {
  EXPECT_THROW(DutyCycle{}.Validate(), std::invalid_argument);
  const DutyCycle good = ConstantSpeed(1, 4);
  EXPECT_NO_THROW(good.Validate());
  DutyCycle bad = good;
  bad.speed.pop_back();
  EXPECT_THROW(bad.Validate(), std::invalid_argument);
  bad = good;
  bad.duration[2] = -1;
  EXPECT_THROW(bad.Validate(), std::invalid_argument);
  bad = good;
  bad.duration.assign(4, 0.0);
  EXPECT_THROW(bad.Validate(), std::invalid_argument);
  bad = good;
  bad.wrench[1].moment.y() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(bad.Validate(), std::invalid_argument);
}

}  // namespace
}  // namespace vmech
