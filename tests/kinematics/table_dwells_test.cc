#include "vmech/kinematics/motion/table_dwells.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "vmech/kinematics/motion/motion_law.h"

namespace vmech {
namespace {

std::vector<double> Seconds(size_t count) {
  std::vector<double> t;
  for (size_t i = 0; i < count; ++i) t.push_back(static_cast<double>(i));
  return t;
}

/// The intervals that are dwells, as a word: "..--.".
std::string DwellsOf(const std::vector<double>& y) {
  std::string word;
  for (const bool dwell : FindDwells(Seconds(y.size()), {y})) word += dwell ? '-' : '.';
  return word;
}

TEST(TableDwells, AreEqualRowsThatAreNoTurningPoint) {
  EXPECT_EQ(DwellsOf({0, 1, 2, 2, 2, 1, 0}), "..--..");            // three rows
  EXPECT_EQ(DwellsOf({0, 0, 1, 2, 2}), "-..-");                    // at the ends
  EXPECT_EQ(DwellsOf({0, 1, 2, 2, 3, 4}), "..-..");                // goes on
  EXPECT_EQ(DwellsOf({0, 1, 2, 2, 1, 0}), "..-..");                // straight up to it and down
  EXPECT_EQ(DwellsOf({-9, -4, -1, 0, 0, -1, -4, -9}), "...-...");  // comes to rest
  EXPECT_EQ(DwellsOf({0, 1, 2, 3}), "...");
  EXPECT_EQ(DwellsOf({1, 2, 2, 1}), "...");  // a parabola, for all that is known
  EXPECT_EQ(DwellsOf({3}), "");
}

TEST(TableDwells, AreNotSeenInASmoothTableSampledAboutItsTurningPoints) {
  for (const int rows : {8, 12, 36, 360}) {
    std::vector<double> quarter;
    for (int i = 0; i < rows; ++i) {
      quarter.push_back(std::cos(std::numbers::pi * (2 * i + 1) / rows));
    }
    // To the last bit, as a printed table has it.
    for (int i = 0; i < rows / 2; ++i) quarter[rows - 1 - i] = quarter[i];
    std::vector<double> y = quarter;
    y.insert(y.end(), quarter.begin(), quarter.end());
    EXPECT_EQ(DwellsOf(y).find('-'), std::string::npos) << rows;
  }
}

TEST(TableDwells, StandExactlyStillAndAreEnteredWithoutRinging) {
  const std::vector<double> y{0, 1, 2, 2, 2, 2, 1, 0};
  const MotionLaw law = MotionLaw::Table(Seconds(y.size()), y);
  for (int i = 0; i <= 300; ++i) {
    const MotionSample s = law.At(2 + i / 100.0);
    EXPECT_EQ(s.position, 2);
    EXPECT_EQ(s.velocity, 0);
    EXPECT_EQ(s.acceleration, 0);
  }
  constexpr double kStep = 1e-7;
  for (const double edge : {2 - kStep, 5 + kStep}) {
    EXPECT_NEAR(law.At(edge).velocity, 0, 10 * kStep);
    EXPECT_NEAR(law.At(edge).position, 2, kStep);
  }
  for (size_t i = 0; i < y.size(); ++i) EXPECT_NEAR(law.At(i).position, y[i], 1e-14);
}

TEST(TableDwells, AreLeftOnASmoothStepAndAParabola) {
  const MotionLaw step = MotionLaw::Table({0, 1, 3, 4}, {0, 0, 1, 1});
  EXPECT_NEAR(step.At(2).position, 0.5, 1e-15);
  EXPECT_NEAR(step.At(2).velocity, 0.75, 1e-15);
  const MotionLaw leaves = MotionLaw::Table({0, 1, 3}, {0, 0, 8}),
                  arrives = MotionLaw::Table({0, 2, 3}, {8, 0, 0});
  EXPECT_NEAR(leaves.At(2).position, 2, 1e-15);
  EXPECT_NEAR(arrives.At(1).position, 2, 1e-15);
}

// The spline from rest through its rows has their slope and curvature in between.
TEST(TableDwells, AreLeftOnTheCubicThatTheRowsAreOn) {
  std::vector<double> t{-2, -1}, y{0, 0};
  for (const double x : {0.0, 0.5, 1.2, 2.0, 2.5}) {
    t.push_back(x);
    y.push_back(x * x * (3 - x));
  }
  const MotionLaw law = MotionLaw::Table(t, y);
  for (const double x : {0.1, 0.9, 1.7, 2.4}) {
    EXPECT_NEAR(law.At(x).position, x * x * (3 - x), 1e-14);
    EXPECT_NEAR(law.At(x).velocity, 3 * x * (2 - x), 1e-13);
    EXPECT_NEAR(law.At(x).acceleration, 6 - 6 * x, 1e-13);
  }
}

TEST(TableDwells, OfAHandAreThoseOfItsPositionAndOfItsOrientation) {
  std::vector<Posed> poses;
  for (const double x : {0.0, 1.0, 2.0, 2.0, 2.0, 3.0, 4.0}) {
    const Eigen::AngleAxisd turn(0.1 * static_cast<double>(poses.size()), Vector3d::UnitZ());
    poses.push_back({turn.toRotationMatrix(), Vector3d(x, 1, -x)});
  }
  const HandLaw law = HandLaw::Table(Seconds(poses.size()), poses);
  for (const double t : {2.0, 2.3, 3.1, 4.0}) {
    EXPECT_TRUE(law.At(t).V_WH.head<3>().isZero(0)) << t;
    EXPECT_NEAR(law.At(t).V_WH[5], 0.1, 1e-12) << t;
  }
}

}  // namespace
}  // namespace vmech
