#include "vmech/mechanisms/mass_properties.h"

#include <gtest/gtest.h>

#include <numbers>

namespace vmech::mass_properties_test {
namespace {

constexpr double kRounding = 1e-14;  // relative: some ten operations on numbers of order one

Matrix3d Rotation(double angle, const Vector3d& axis) {
  return Eigen::AngleAxisd(angle, axis.normalized()).toRotationMatrix();
}

/// A box of sides a, b, c about its centre: m/12 (b^2 + c^2) and so on.
Matrix3d Box(double mass, const Vector3d& sides) {
  const Vector3d s = sides.cwiseAbs2() * mass / 12;
  return Vector3d(s[1] + s[2], s[0] + s[2], s[0] + s[1]).asDiagonal();
}

TEST(ParallelAxes, GiveTheRodAboutItsEnd) {
  const double mass = 3, length = 2;
  const Matrix3d rod = Vector3d(0, 1, 1).asDiagonal() * (mass * length * length / 12);
  const Matrix3d end = InertiaAboutPoint(rod, mass, {length / 2, 0, 0});
  EXPECT_NEAR(end(1, 1), mass * length * length / 3, kRounding);
  EXPECT_NEAR(end(0, 0), 0, kRounding);
}

TEST(ParallelAxes, GiveTheBoxAboutItsCorner) {
  const double m = 2, a = 1, b = 2, c = 3;
  const Matrix3d corner = InertiaAboutPoint(Box(m, {a, b, c}), m, {a / 2, b / 2, c / 2});
  EXPECT_NEAR(corner(0, 0), m * (b * b + c * c) / 3, kRounding);
  EXPECT_NEAR(corner(0, 1), -m * a * b / 4,
              kRounding);  // the element: minus the product of inertia
  EXPECT_NEAR(corner(1, 2), -m * b * c / 4, kRounding);
}

TEST(ParallelAxes, ThereAndBackChangeNothing) {
  const Matrix3d box = Box(2, {1, 2, 3});
  const Vector3d p(0.3, -0.2, 0.7);
  const Matrix3d back = InertiaAboutCenterOfGravity(InertiaAboutPoint(box, 2, p), 2, p);
  EXPECT_TRUE(back.isApprox(box, kRounding));
}

TEST(RotatedInertia, OfAQuarterTurnSwapsTheMoments) {
  const Matrix3d turned =
      RotatedInertia(Rotation(std::numbers::pi / 2, Vector3d::UnitZ()), Box(2, {1, 2, 3}));
  EXPECT_TRUE(turned.isApprox(Box(2, {2, 1, 3}), kRounding));
}

TEST(RotatedInertia, KeepsThePrincipalMoments) {
  const Matrix3d box = Box(2, {1, 2, 3});
  const Vector3d moments = PrincipalMoments(RotatedInertia(Rotation(0.7, {1, 2, 3}), box));
  EXPECT_TRUE(moments.isApprox(PrincipalMoments(box), kRounding));
}

TEST(InertiaDefect, PassesBoxesPlatesRodsAndPoints) {
  for (const Vector3d& sides :
       {Vector3d(1, 2, 3), Vector3d(1, 2, 0), Vector3d(1, 0, 0), Vector3d(0, 0, 0)}) {
    const Matrix3d I = RotatedInertia(Rotation(1.1, {3, 1, -2}), Box(5, sides));
    EXPECT_EQ(InertiaDefect(I, I.cwiseAbs().maxCoeff()), "") << sides.transpose();
  }
}

TEST(InertiaDefect, PassesAPlateRoundedToThreeDigits) {
  const Matrix3d plate = Vector3d(1.23, 4.56, 5.81).asDiagonal();  // 1.234 + 4.564 = 5.798
  EXPECT_EQ(InertiaDefect(plate, 5.81), "");
}

TEST(InertiaDefect, FindsWhatNoBodyHas) {
  const Matrix3d negative = Vector3d(-1, 2, 2).asDiagonal();
  EXPECT_NE(InertiaDefect(negative, 2).find("not positive definite"), std::string::npos);
  const Matrix3d skewed = InertiaFromElements(1, 1, 1, 2, 0, 0);  // moments -1, 1, 3
  EXPECT_NE(InertiaDefect(skewed, 2).find("not positive definite"), std::string::npos);
  const Matrix3d needle = Vector3d(1, 1, 3).asDiagonal();
  EXPECT_NE(InertiaDefect(needle, 3).find("exceeds the sum"), std::string::npos);
}

}  // namespace
}  // namespace vmech::mass_properties_test
