#include "vmech/base/rotation_error.h"

#include <gtest/gtest.h>

namespace vmech {
namespace {

constexpr double kRoundoff = 1e-14;

/// Turns by 0, by little, on both sides of where the series end, and by most of half a turn.
class EveryAngle : public testing::TestWithParam<double> {};

TEST_P(EveryAngle, RotationIsThatOfEigen) {
  const Vector3d axis = Vector3d(1, -2, 0.5).normalized();
  const Matrix3d expected = Eigen::AngleAxisd(GetParam(), axis).toRotationMatrix();
  EXPECT_LT((RotationBy(GetParam() * axis) - expected).norm(), kRoundoff);
}

TEST_P(EveryAngle, HandErrorLeadsWhereItIsDisplacedTo) {
  const Posed X{RotationBy({0.3, 0.2, -0.9}), Vector3d(1, 2, 3)};
  Vector6d way;
  way << 0.1, -0.2, 0.3, GetParam() * Vector3d(1, -2, 0.5).normalized();
  EXPECT_LT((HandError(X, Displaced(X, way)) - way).norm(), kRoundoff);
}

INSTANTIATE_TEST_SUITE_P(Angles, EveryAngle,
                         testing::Values(0, 1e-9, 1e-3, 0.0999, 0.1001, 0.3, 0.505, 0.506, 1.6,
                                         3.0));

}  // namespace
}  // namespace vmech
