#include "vmech/mechanisms/cad/contacts.h"

#include <stdexcept>

#include <gtest/gtest.h>

namespace vmech::contacts_test {
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

TEST(Contacts, AGapOfExactlyTheToleranceIsInContactHoweverItIsRounded) {
  // 0.1 mm as it comes out of sums and products of millimetres.
  for (const double gap : {1e-4, 0.0301 - 0.03, 0.1 * 1e-3, 1.0001 - 1, 0.5 - 0.4999}) {
    EXPECT_TRUE(ProposeJoint({Plane({0, 0, 0}, kZ)}, {Plane({0, 0, gap}, -kZ)})) << gap;
    EXPECT_TRUE(ProposeJoint({Shaft({0, 0, 0}, kZ)}, {Bore({gap, 0, 0}, kZ)})) << gap;
    EXPECT_TRUE(ProposeJoint({Shaft({0, 0, 0}, kZ, 0.003)}, {Bore({0, 0, 0}, kZ, 0.003 + gap)}));
    EXPECT_FALSE(ProposeJoint({Plane({0, 0, 0}, kZ)}, {Plane({0, 0, gap + 1e-8}, -kZ)})) << gap;
  }
}

/// A shaft with shoulders around a bore of 20 mm length, `play` at either end.
WorldFeatures Spool(double play) {
  return {Shaft({0, 0, 0}, kZ), Plane({0, 0, 0.01 + play}, -kZ), Plane({0, 0, -0.01 - play}, kZ)};
}

TEST(Contacts, AShaftWithEndPlayBetweenShouldersIsRevolute) {
  const WorldFeatures ring{Bore({0, 0, 0}, kZ), Plane({0, 0, 0.01}, kZ), Plane({0, 0, -0.01}, -kZ)};
  EXPECT_EQ(ProposeJoint(Spool(0.0009), ring)->type, JointType::kRevolute);
  EXPECT_EQ(ProposeJoint(ring, Spool(0.0009))->type, JointType::kRevolute);
  EXPECT_EQ(ProposeJoint(Spool(0.0011), ring)->type, JointType::kCylindrical)
      << "more than a tenth";
  WorldFeatures open = Spool(0.0009);
  open.pop_back();
  EXPECT_EQ(ProposeJoint(open, ring)->type, JointType::kCylindrical) << "it can be drawn out";
}

TEST(Contacts, TwoFitsOfOneAxisThatAreALittleOffStillTurn) {
  const Vector3d tilted = Vector3d(5e-4, 0, 1).normalized();
  const WorldFeatures door{Bore({0, 0, 0}, kZ), Bore({0.00008, 0, 0.5}, kZ)};
  const WorldFeatures post{Shaft({0, 0, 0}, kZ), Shaft({0.00008, 0, 0.5}, tilted),
                           Plane({0, 0, 0.01}, tilted)};
  const auto joint = ProposeJoint({door[0], door[1], Plane({0, 0, 0.01}, -kZ)}, post);
  ASSERT_TRUE(joint);
  EXPECT_EQ(joint->type, JointType::kRevolute);
  EXPECT_EQ(ProposeJoint(door, {post[0], post[1]})->type, JointType::kCylindrical);
}

TEST(Contacts, ADoorDrawnAtItsStopIsAHingeAndAKeyedHubIsNot) {
  const WorldFeatures post{Shaft({0, 0, 0}, kZ), Plane({0, 0, 0.01}, kZ),
                           Plane({0.2, 0, 0}, kY, 0.05)};
  const WorldFeatures door{Bore({0, 0, 0}, kZ), Plane({0, 0, 0.01}, -kZ),
                           Plane({0.2, 0, 0}, -kY, 0.05)};
  EXPECT_EQ(ProposeJoint(post, door)->type, JointType::kRevolute);
  const WorldFeatures key{Shaft({0, 0, 0}, kZ), Plane({0, 0, 0.01}, kZ),
                          Plane({0, 0.008, 0}, kY, 0.004)};
  const WorldFeatures hub{Bore({0, 0, 0}, kZ), Plane({0, 0, 0.01}, -kZ),
                          Plane({0, 0.008, 0}, -kY, 0.004)};
  EXPECT_EQ(ProposeJoint(key, hub)->type, JointType::kWeld) << "its flat reaches past the axis";
}

WorldFeatures OfFastener(WorldFeatures features) {
  for (CadFeature& feature : features) feature.fastens = true;
  return features;
}

TEST(Contacts, ScrewsSitInClearanceHolesAndInCoreHoles) {
  const WorldFeatures screw{Shaft({0, 0, 0}, kZ, 0.002)};
  for (const double hole : {0.00225, 0.0016}) {
    const WorldFeatures plate{Bore({0, 0, 0}, kZ, hole)};
    EXPECT_FALSE(ProposeJoint(screw, plate)) << hole;
    const auto joint = ProposeJoint(OfFastener(screw), plate);
    ASSERT_TRUE(joint) << hole;
    EXPECT_TRUE(joint->fastened);
  }
  EXPECT_FALSE(ProposeJoint(OfFastener(screw), {Bore({0, 0, 0}, kZ, 0.003)}));
}

TEST(Contacts, WhatMissesByALittleIsToldWithItsGap) {
  const WorldFeatures shaft{Shaft({0, 0, 0}, kZ)};
  const auto miss = [&](const CadFeature& bore) {
    const std::vector<std::string> misses = FindNearMisses({bore}, shaft);
    return misses.empty() ? "none" : misses.front();
  };
  EXPECT_EQ(miss(Bore({0.00012, 0, 0}, kZ)),
            "shaft of 20 mm and bore of 20 mm: axes 0.12 mm apart, 0.1 mm allowed");
  EXPECT_EQ(miss(Bore({0, 0, 0}, kZ, 0.0105)),
            "shaft of 20 mm and bore of 21 mm: play of 0.5 mm on the radius, 0.21 mm allowed");
  EXPECT_EQ(miss(Bore({0, 0, 0}, Vector3d(0.002, 0, 1).normalized())),
            "shaft of 20 mm and bore of 20 mm: axes 0.115 deg off parallel, 0.0573 deg allowed");
  EXPECT_EQ(miss(Bore({0.0001, 0, 0}, kZ)), "none") << "it fits";
  EXPECT_EQ(miss(Bore({0.001, 0, 0}, kZ)), "none") << "a neighbour";
  EXPECT_EQ(miss(Bore({0.00012, 0, 0.05}, kZ)), "none") << "above";
}

TEST(Contacts, AFitIsCalledByItsNominalDiameter) {
  struct Fit {
    double shaft, bore, nominal;  // [mm]
  };
  for (const Fit& fit :
       {Fit{9.98, 10, 10}, Fit{9.98, 10.02, 10}, Fit{10, 10.05, 10}, Fit{9.96, 9.99, 10},
        Fit{20.009, 20.01, 20}, Fit{9.98, 0, 10}, Fit{20.015, 0, 20}, Fit{6.35, 6.4, 6.4},
        Fit{19.03, 19.05, 19.05}, Fit{19.05, 19.05, 19.05}, Fit{6.35, 0, 6.35}, Fit{17, 17, 17}}) {
    EXPECT_NEAR(NominalDiameter(1e-3 * fit.shaft, 1e-3 * fit.bore), 1e-3 * fit.nominal, kRoundoff)
        << fit.shaft << " in " << fit.bore;
  }
}

TEST(Contacts, SeatOfAPinWithPlayHasTheNominalDiameterOfTheFit) {
  const JointSeat seat = FindSeat({Bore({0, 0, 0}, kZ, 0.005)}, {Shaft({0, 0, 0}, kZ, 0.00499)},
                                  {Matrix3d::Identity(), {0, 0, 0}});
  EXPECT_NEAR(seat.shaft_diameter, 0.00998, kRoundoff);
  EXPECT_NEAR(seat.bore_diameter, 0.010, kRoundoff);
  EXPECT_NEAR(seat.nominal_diameter, 0.010, kRoundoff);
  EXPECT_EQ(seat.housing_diameter, 0);
}

TEST(Contacts, OptionsOutOfRangeAreRefused) {
  ContactOptions options;
  options.tolerance = 0;
  EXPECT_THROW(ProposeJoint({}, {}, options), std::invalid_argument);
}

}  // namespace
}  // namespace vmech::contacts_test
