#include "vmech/kinematics/motion/motion_law.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <stdexcept>

namespace vmech {
namespace {

constexpr double kRoundoff = 1e-11;

std::vector<double> Cubic(const std::vector<double>& t) {
  std::vector<double> y;
  for (double x : t) y.push_back(1 - 2 * x + 3 * x * x - 0.5 * x * x * x);
  return y;
}

TEST(MotionLaw, ReproducesACubicFromUnevenRows) {
  const std::vector<double> t{0, 0.3, 0.5, 1.1, 1.2, 2};
  const MotionLaw law = MotionLaw::Table(t, Cubic(t));
  for (double x : {0.0, 0.1, 0.4, 1.15, 1.9, 2.0}) {
    const MotionSample s = law.At(x);
    EXPECT_NEAR(s.position, 1 - 2 * x + 3 * x * x - 0.5 * x * x * x, kRoundoff);
    EXPECT_NEAR(s.velocity, -2 + 6 * x - 1.5 * x * x, kRoundoff);
    EXPECT_NEAR(s.acceleration, 6 - 3 * x, kRoundoff);
  }
}

TEST(MotionLaw, OfThreeRowsIsTheParabolaOfTwoTheLineOfOneAtRest) {
  EXPECT_NEAR(MotionLaw::Table({0, 1, 3}, {0, 1, 9}).At(2).position, 4, kRoundoff);
  EXPECT_NEAR(MotionLaw::Table({0, 2}, {1, 5}).At(1.5).velocity, 2, kRoundoff);
  EXPECT_EQ(MotionLaw::Table({0}, {7}).At(3).velocity, 0);
}

TEST(MotionLaw, IsUniform) {
  const MotionSample s = MotionLaw::Uniform(1, 2, 3).At(2);
  EXPECT_EQ(s.position, 11);
  EXPECT_EQ(s.velocity, 8);
  EXPECT_EQ(s.acceleration, 3);
}

TEST(MotionLaw, RefusesTablesThatAreNotFunctionsOfTime) {
  EXPECT_THROW(MotionLaw::Table({}, {}), std::invalid_argument);
  EXPECT_THROW(MotionLaw::Table({0, 0}, {1, 2}), std::invalid_argument);
  EXPECT_THROW(MotionLaw::Table({0, 1}, {1}), std::invalid_argument);
  EXPECT_THROW(MotionLaw::Table({0, NAN}, {1, 2}), std::invalid_argument);
}

TEST(HandLaw, TwistAndAccelerationAreTheDerivativesOfThePose) {
  std::vector<double> t;
  std::vector<Posed> poses;
  for (int i = 0; i < 9; ++i) {
    t.push_back(0.1 * i);
    const Eigen::AngleAxisd turn(0.2 * i, Vector3d(1, 2, std::sin(i)).normalized());
    poses.push_back({turn.toRotationMatrix(), Vector3d(i, std::cos(i), 0)});
  }
  const HandLaw law = HandLaw::Table(t, poses);
  constexpr double kStep = 1e-5, kDifference = 1e-6;
  for (double time : {0.0, 0.05, 0.33, 0.71}) {
    const HandSample now = law.At(time), ahead = law.At(time + kStep),
                     behind = law.At(time - kStep);
    const Matrix3d W = (ahead.X_WH.R - behind.X_WH.R) / (2 * kStep) * now.X_WH.R.transpose();
    EXPECT_LT((W - CrossMatrix<double>(now.V_WH.tail<3>())).norm(), kDifference) << time;
    const Vector6d A = (ahead.V_WH - behind.V_WH) / (2 * kStep);
    EXPECT_LT((A - now.A_WH).norm(), kDifference * (1 + A.norm())) << time;
  }
  EXPECT_LT((law.At(0.4).X_WH.R - poses[4].R).norm(), kRoundoff);
}

}  // namespace
}  // namespace vmech
