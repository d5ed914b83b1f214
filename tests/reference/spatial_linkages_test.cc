#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "reference_case.h"

namespace vmech::reference::spatial_linkages_test {
namespace {

constexpr double kTolerance =
    1e-10;  // [m] and [rad]; the two methods behind each table agree to it

double Degrees(double angle) {
  return angle * std::numbers::pi / 180;
}

void ExpectAngle(double actual, double expected, const std::string& what) {
  EXPECT_NEAR(std::remainder(actual - expected, 2 * std::numbers::pi), 0, kTolerance) << what;
}

/// Leads the input from the start of the mechanism to the given angle.
PoseLoads Led(const Mechanism& mechanism, double angle) {
  return AfterLeading(mechanism, "input", angle);
}

/// Spherical four-bar with sides of 40, 70, 60 and 90 degrees: closed form of Freudenstein's kind,
/// and Newton's method on the closure of the Denavit-Hartenberg frames.
TEST(SphericalFourBar, ClosesAsInTheClosedFormInBothModes) {
  struct Row {
    double input, one[3], other[3];
  };
  constexpr Row kRows[] = {
      {10,
       {2.7416968397195296, 0.15507320869634134, 2.8083024796454046},
       {3.0890125919202056, -0.15507320869634178, -3.0976822636718975}},
      {60,
       {1.1716086619330177, 0.9209436012504248, 1.6022522040989102},
       {2.8028081543164713, -0.9209436012504248, -2.8590712970502663}},
      {120,
       {0.03737054801047757, 1.75665708009668, 1.1653337486257023},
       {2.271397942919621, -1.7566570800966796, -2.4221528415770583}},
      {200,
       {-1.6117754734666123, 2.131862109888747, 1.9082740198796833},
       {0.7246676586843206, -2.131862109888747, -1.3493185215988923}},
      {300,
       {-2.802808154316472, 0.9209436012504248, 2.8590712970502663},
       {-1.171608661933017, -0.9209436012504248, -1.6022522040989098}},
  };
  const char* kJoints[] = {"crank_pin", "rocker_pin", "output"};
  const Mechanism one = Example("spherical-four-bar");
  Mechanism other = one;
  for (int i = 0; i < 3; ++i) SetStart(&other, kJoints[i], {kRows[1].other[i]});
  for (const Row& row : kRows) {
    const PoseLoads loads = Led(one, Degrees(row.input)), crossed = Led(other, Degrees(row.input));
    for (int i = 0; i < 3; ++i) {
      ExpectAngle(Position(one, loads, kJoints[i]), row.one[i], kJoints[i]);
      ExpectAngle(Position(other, crossed, kJoints[i]), row.other[i], kJoints[i]);
    }
  }
}

/// Bennett linkage: tan(q1/2) tan(q2/2) = sin((b + a)/2) / sin((b - a)/2), q3 = -q1, q4 = -q2.
TEST(Bennett, ObeysItsClassicalRelation) {
  const Mechanism bennett = Example("bennett");
  const double product = std::sin(Degrees(45)) / std::sin(Degrees(-15));
  for (const double degrees : {20, 45, 90, 135, 170}) {
    const double input = Degrees(degrees);
    const double crank_pin = 2 * std::atan(product / std::tan(input / 2));
    const PoseLoads loads = Led(bennett, input);
    ExpectAngle(Position(bennett, loads, "crank_pin"), crank_pin, "crank_pin");
    ExpectAngle(Position(bennett, loads, "rocker_pin"), -input, "rocker_pin");
    ExpectAngle(Position(bennett, loads, "output"), -crank_pin, "output");
  }
}

/// RSSR: |B - A| is the length of the rod.
TEST(Rssr, OutputFollowsTheClosedForm) {
  constexpr double kRows[][2] = {{0, 1.6654260893307615},   {45, 1.422806772461814},
                                 {90, 1.7903247365646493},  {135, 2.2511610200100414},
                                 {180, 2.6180392765925893}, {225, 2.76288376096731},
                                 {270, 2.648698236729259},  {315, 2.286230935337766}};
  const Mechanism rssr = Example("rssr");
  for (const auto& [degrees, output] : kRows) {
    ExpectAngle(Position(rssr, Led(rssr, Degrees(degrees)), "output"), output, "output");
  }
}

Matrix3d AboutX(double angle) {
  return Eigen::AngleAxisd(angle, Vector3d::UnitX()).toRotationMatrix();
}

/// The RCCC linkage with standard Denavit-Hartenberg frames; the last side is the ground.
Mechanism Rccc() {
  const double a[] = {0.3, 0.5, 0.4, 0.8};
  const double alpha[] = {Degrees(40), Degrees(70), Degrees(60), Degrees(90)};
  const char* kNames[] = {"crank", "coupler", "rocker"};
  Mechanism rccc;
  const Matrix3d R_G = AboutX(-alpha[3]);
  rccc.links.push_back({"frame", {}, {{"input", {}}, {"output", {R_G, {-a[3], 0, 0}}}}});
  for (int i = 0; i < 3; ++i) {
    const Posed near{Matrix3d::Identity(), {0, 0, i == 0 ? -0.2 : 0}};  // d1 = 0.2 m
    rccc.links.push_back({kNames[i],
                          {1, Vector3d::Zero(), 0.01 * Matrix3d::Identity()},
                          {{"near", near}, {"far", {AboutX(alpha[i]), {a[i], 0, 0}}}}});
  }
  rccc.joints = {MakeJoint("input", JointType::kRevolute, {0, 0}, {1, 0}),
                 MakeJoint("c2", JointType::kCylindrical, {1, 1}, {2, 0}),
                 MakeJoint("c3", JointType::kCylindrical, {2, 1}, {3, 0}),
                 MakeJoint("c4", JointType::kCylindrical, {3, 1}, {0, 1})};
  return rccc;
}

/// RCCC: its rotations are those of the spherical four-bar above (principle of transference).
TEST(Rccc, SlidesAsNewtonsMethodOnTheClosureSays) {
  struct Row {
    double input, angle[3], slide[3];
  };
  constexpr Row kRows[] = {
      {60,
       {1.1716086619330177, 0.9209436012504248, 1.6022522040989093},
       {-1.1662746341791852, -0.09210923097018155, -0.9333394343970097}},
      {10,
       {2.7416968397195305, 0.15507320869634134, 2.8083024796454055},
       {0.5217827703021344, -1.0456117103252778, 0.7341316263000115}},
      {120,
       {0.03737054801047757, 1.75665708009668, 1.1653337486257023},
       {-0.809712097721635, -0.11914449868361747, -0.3655540838683545}},
  };
  const char* kJoints[] = {"c2", "c3", "c4"};
  Mechanism rccc = Rccc();
  SetStart(&rccc, "input", {Degrees(kRows[0].input)});
  for (int i = 0; i < 3; ++i) SetStart(&rccc, kJoints[i], {kRows[0].slide[i], kRows[0].angle[i]});
  for (const Row& row : kRows) {
    const PoseLoads loads = Led(rccc, Degrees(row.input));
    for (int i = 0; i < 3; ++i) {
      const Vector3d& position = loads.joints[FindJoint(rccc, kJoints[i])].position;
      EXPECT_NEAR(position[0], row.slide[i], kTolerance) << kJoints[i];
      ExpectAngle(position[1], row.angle[i], kJoints[i]);
    }
  }
}

}  // namespace
}  // namespace vmech::reference::spatial_linkages_test
