#include "vmech/mechanisms/cad/contacts.h"

#include <gtest/gtest.h>

namespace vmech {
namespace {

constexpr double kRoundoff = 1e-12;
const Vector3d kX{1, 0, 0}, kY{0, 1, 0}, kZ{0, 0, 1};

CadFeature Round(CadSurface surface, const Vector3d& middle, const Vector3d& z, double radius,
                 double length) {
  CadFeature feature;
  feature.surface = surface;
  feature.X_PF = {AxesFromZX(z, {0.3, 0.5, 0.7}), middle};
  feature.radius = radius;
  feature.length = length;
  return feature;
}

/// A square of a given half side.
CadFeature Plane(const Vector3d& middle, const Vector3d& normal, double half = 0.05) {
  CadFeature feature;
  feature.X_PF = {AxesFromZX(normal, std::abs(normal.x()) < 0.9 ? kX : kY), middle};
  feature.lower = {-half, -half, 0};
  feature.upper = {half, half, 0};
  return feature;
}

CadFeature Shaft(const Vector3d& middle, const Vector3d& z, double radius = 0.01) {
  return Round(CadSurface::kShaft, middle, z, radius, 0.04);
}
CadFeature Bore(const Vector3d& middle, const Vector3d& z, double radius = 0.01) {
  return Round(CadSurface::kBore, middle, z, radius, 0.02);
}

TEST(Contacts, ShaftInBoreIsCylindricalInTheMiddleOfTheFit) {
  const Vector3d z = Vector3d(1, 2, 2) / 3;
  const auto joint = ProposeJoint({Shaft(Vector3d::Zero(), z)}, {Bore(0.015 * z, -z)});
  ASSERT_TRUE(joint);
  EXPECT_EQ(joint->type, JointType::kCylindrical);
  EXPECT_NEAR(joint->X_WJ.R.col(2).cross(z).norm(), 0, kRoundoff);
  EXPECT_NEAR((joint->X_WJ.p - 0.0125 * z).norm(), 0, kRoundoff);
  EXPECT_EQ(joint->radius, 0.01);
}

TEST(Contacts, AShoulderMakesItRevolute) {
  const auto joint = ProposeJoint({Shaft({0, 0, 0}, kZ), Plane({0, 0, 0.01}, kZ)},
                                  {Bore({0, 0, 0}, kZ), Plane({0, 0, 0.01}, -kZ)});
  ASSERT_TRUE(joint);
  EXPECT_EQ(joint->type, JointType::kRevolute);
  EXPECT_NEAR(joint->X_WJ.p.norm(), 0, kRoundoff) << "in the middle of the fit";
}

TEST(Contacts, TwoGuideRodsArePrismatic) {
  const auto joint = ProposeJoint({Shaft({0, 0, 0}, kY), Shaft({0.1, 0, 0}, kY)},
                                  {Bore({0, 0, 0}, kY), Bore({0.1, 0, 0}, kY)});
  ASSERT_TRUE(joint);
  EXPECT_EQ(joint->type, JointType::kPrismatic);
  EXPECT_NEAR(joint->X_WJ.R.col(2).cross(kY).norm(), 0, kRoundoff);
}

TEST(Contacts, ABlockInAGrooveSlidesAlongIt) {
  const auto joint = ProposeJoint({Plane({0, 0, 0}, kZ), Plane({0, 0.02, 0.02}, -kY)},
                                  {Plane({0, 0, 0}, -kZ), Plane({0, 0.02, 0.02}, kY)});
  ASSERT_TRUE(joint);
  EXPECT_EQ(joint->type, JointType::kPrismatic);
  EXPECT_NEAR(joint->X_WJ.R.col(2).cross(kX).norm(), 0, kRoundoff);
}

TEST(Contacts, OnePlanePlanarThreeWeldABallSpherical) {
  const auto planar = ProposeJoint({Plane({0, 0, 0}, kZ)}, {Plane({0.01, 0, 0}, -kZ)});
  ASSERT_TRUE(planar);
  EXPECT_EQ(planar->type, JointType::kPlanar);
  const auto weld =
      ProposeJoint({Plane({0, 0, 0}, kX), Plane({0, 0, 0}, kY), Plane({0, 0, 0}, kZ)},
                   {Plane({0, 0, 0}, -kX), Plane({0, 0, 0}, -kY), Plane({0, 0, 0}, -kZ)});
  ASSERT_TRUE(weld);
  EXPECT_EQ(weld->type, JointType::kWeld);
  const auto ball = ProposeJoint({Round(CadSurface::kBall, {1, 2, 3}, kZ, 0.01, 0)},
                                 {Round(CadSurface::kSocket, {1, 2, 3}, kX, 0.01, 0)});
  ASSERT_TRUE(ball);
  EXPECT_EQ(ball->type, JointType::kSpherical);
  EXPECT_NEAR((ball->X_WJ.p - Vector3d(1, 2, 3)).norm(), 0, kRoundoff);
}

TEST(Contacts, TwoBallsTurnAboutTheLineThroughThem) {
  const auto joint = ProposeJoint({Round(CadSurface::kBall, {0, 0, 0}, kZ, 0.01, 0),
                                   Round(CadSurface::kBall, {0.1, 0.1, 0}, kZ, 0.01, 0)},
                                  {Round(CadSurface::kSocket, {0, 0, 0}, kZ, 0.01, 0),
                                   Round(CadSurface::kSocket, {0.1, 0.1, 0}, kZ, 0.01, 0)});
  ASSERT_TRUE(joint);
  EXPECT_EQ(joint->type, JointType::kRevolute);
  EXPECT_NEAR(joint->X_WJ.R.col(2).cross(Vector3d(1, 1, 0).normalized()).norm(), 0, 1e-9);
}

TEST(Contacts, NeighboursThatDoNotTouchHaveNone) {
  const WorldFeatures shaft{Shaft({0, 0, 0}, kZ)};
  EXPECT_FALSE(ProposeJoint(shaft, {Bore({0.001, 0, 0}, kZ)})) << "beside";
  EXPECT_FALSE(ProposeJoint(shaft, {Bore({0, 0, 0.05}, kZ)})) << "above";
  EXPECT_FALSE(ProposeJoint(shaft, {Bore({0, 0, 0}, kZ, 0.012)})) << "too wide";
  EXPECT_FALSE(ProposeJoint(shaft, {Shaft({0, 0, 0}, kZ)})) << "two shafts";
  EXPECT_FALSE(ProposeJoint({Plane({0, 0, 0}, kZ)}, {Plane({0, 0, 0.001}, -kZ)})) << "a gap";
  EXPECT_FALSE(ProposeJoint({Plane({0, 0, 0}, kZ)}, {Plane({0.2, 0, 0}, -kZ)})) << "aside";
  EXPECT_FALSE(ProposeJoint({Plane({0, 0, 0}, kZ)}, {Plane({0, 0, 0}, kZ)})) << "same side";
}

TEST(Contacts, SeatIsTheShaftWithTheBoresAroundIt) {
  const WorldFeatures housing{Bore({0, 0, -0.015}, kZ, 0.021), Bore({0, 0, 0.01}, kZ, 0.021),
                              Bore({0.1, 0, 0}, kZ, 0.021)};
  const WorldFeatures crank{Shaft({0, 0, 0}, kZ, 0.010), Shaft({0.1, 0, 0}, kY, 0.008),
                            Round(CadSurface::kShaft, {0, 0, 0.5}, kZ, 0.03, 0.01)};
  const JointSeat seat = FindSeat(housing, crank, {Matrix3d::Identity(), {0, 0, 0.002}});
  EXPECT_EQ(seat.shaft_diameter, 0.020);
  EXPECT_EQ(seat.housing_diameter, 0.042);
  ASSERT_EQ(seat.positions.size(), 2u);
  EXPECT_NEAR(seat.positions[0], -0.017, kRoundoff);
  EXPECT_NEAR(seat.positions[1], 0.008, kRoundoff);
}

TEST(Contacts, OptionsOutOfRangeAreRefused) {
  ContactOptions options;
  options.tolerance = 0;
  EXPECT_THROW(ProposeJoint({}, {}, options), std::invalid_argument);
}

}  // namespace
}  // namespace vmech
