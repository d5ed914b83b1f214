#include "vmech/mechanisms/mechanism.h"

#include <gtest/gtest.h>

#include <stdexcept>

namespace vmech::mechanism_test {
namespace {

TEST(AxesFromZX, GivesARightHandedFrameWithTheAskedZ) {
  const Matrix3d R = AxesFromZX({0, 0, 2}, {1, 0, 1});
  EXPECT_TRUE(R.isApprox(Matrix3d::Identity(), 1e-15));
  EXPECT_NEAR(AxesFromZX({1, 2, 3}, {0, 1, 0}).determinant(), 1, 1e-14);
}

TEST(AxesFromZX, TakesAxesOfAnyLength) {
  const Matrix3d R = AxesFromZX({1, 2, 3}, {0, 1, 0});
  for (double length : {1e-300, 3e-160, 1e160, 1e300}) {
    const Matrix3d scaled = AxesFromZX(length * Vector3d(1, 2, 3), length * Vector3d::UnitY());
    EXPECT_NEAR((scaled - R).norm(), 0, 1e-15) << length;
  }
}

TEST(AxesFromZX, RefusesAnAxisWithoutLengthOrDirection) {
  EXPECT_THROW(AxesFromZX({0, 0, 0}, {1, 0, 0}), std::invalid_argument);
  EXPECT_THROW(AxesFromZX({0, 0, 1}, {0, 0, 5}), std::invalid_argument);
}

TEST(Joint, HasOneEntryPerFreedom) {
  const Joint planar = MakeJoint("slide", JointType::kPlanar, {0, 0}, {1, 0});
  EXPECT_EQ(planar.start.size(), 3u);
  EXPECT_EQ(planar.lower.size(), 3u);
  const Joint ball = MakeJoint("ball", JointType::kSpherical, {0, 0}, {1, 0});
  EXPECT_EQ(ball.start, (std::vector<double>{1, 0, 0, 0}));
}

}  // namespace
}  // namespace vmech::mechanism_test
