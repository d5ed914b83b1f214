#include "vmech/dynamics/loads/pose/resting_friction.h"
#include "vmech/dynamics/loads/load_result.h"
#include "vmech/dynamics/loads/run_load_study.h"

#include <gmock/gmock.h>

#include <cmath>

#include "driven_examples.h"
#include "one_joint.h"

namespace vmech {
namespace {

constexpr double kExact = 1e-9;

/// A block of 10 kg on a slope that falls along the world's x axis; the joint's z stands on it.
OneJoint BlockOnSlope(double slope, double coefficient, double turn) {
  OneJoint block(JointType::kPlanar, {coefficient, 0.05});
  block.turn = turn;
  block.gravity_W = 10 * Vector3d(std::sin(slope), 0, -std::cos(slope));
  return block;
}

TEST(RestingFriction, HoldsABlockOnAGentleSlope) {
  constexpr double kSlope = 0.25;  // tan 0.255
  for (const double turn : {0.0, 0.4, 2.2}) {
    const LoadStudyResult result = BlockOnSlope(kSlope, 0.3, turn).At({0, 0, 0});
    const PoseLoads& pose = result.poses[0];
    for (const double force : DriveForces(result)) EXPECT_NEAR(force, 0, 100 * kExact);
    const Vector3d f_W = Eigen::AngleAxisd(turn, Vector3d::UnitZ()) * pose.joints[0].force;
    EXPECT_NEAR(f_W.x(), -100 * std::sin(kSlope), 100 * kExact);
    EXPECT_NEAR(f_W.y(), 0, 100 * kExact);
    EXPECT_TRUE(pose.held_by_friction);
  }
}

TEST(RestingFriction, LeavesToTheDrivesWhatASteepSlopeAsks) {
  constexpr double kSlope = 0.6, kMu = 0.3;
  const double left = 100 * (std::sin(kSlope) - kMu * std::cos(kSlope));
  for (const double turn : {0.0, 0.4, 2.2}) {
    const LoadStudyResult result = BlockOnSlope(kSlope, kMu, turn).At({0, 0, 0});
    const auto force = DriveForces(result);
    EXPECT_NEAR(force[0], -left * std::cos(turn), 100 * kExact);
    EXPECT_NEAR(force[1], left * std::sin(turn), 100 * kExact);
    EXPECT_FALSE(result.poses[0].held_by_friction);
  }
}

/// A screw jack under 2000 N, 6 mm in a turn, mean radius 12 mm, at rest.
LoadStudyResult JackAtRest(double coefficient) {
  OneJoint jack(JointType::kScrew, {coefficient, 0.012});
  jack.joint.pitch = 0.006 / 6.283185307179586;
  jack.push_W.force = {0, 0, -2000};
  return jack.At({0});
}

TEST(RestingFriction, HoldsASelfLockingJackAndHelpsToHoldAnother) {
  const LoadStudyResult locked = JackAtRest(0.15);
  EXPECT_NEAR(locked.poses[0].drives[0].force, 0, 2 * kExact);
  EXPECT_TRUE(locked.poses[0].held_by_friction);
  EXPECT_THAT(locked.warnings,
              testing::Contains(testing::HasSubstr("friction alone holds the mechanism")));
  const double lead = std::atan(0.006 / 6.283185307179586 / 0.012);
  const LoadStudyResult slips = JackAtRest(0.05);
  EXPECT_NEAR(slips.poses[0].drives[0].force, 2000 * 0.012 * std::tan(lead - std::atan(0.05)),
              2 * kExact);
  EXPECT_FALSE(slips.poses[0].held_by_friction);
}

/// A wedge under a weight of 500 N that only moves up and down: slopes by `angle`, pushed along x;
/// friction in the slope.
LoadStudy Wedge(double angle, double coefficient) {
  const Vector3d x = Vector3d::UnitX(), y = Vector3d::UnitY(), z = Vector3d::UnitZ();
  const Posed level{AxesFromZX(x, y), Vector3d::Zero()};
  const Posed upright{AxesFromZX(z, y), Vector3d::Zero()};
  const Posed slope{AxesFromZX(-std::cos(angle) * x + std::sin(angle) * z, y), Vector3d::Zero()};
  Mechanism mechanism;
  mechanism.gravity_W = {0, 0, -10};
  mechanism.links = {{"ground", {}, {{"level", level}, {"upright", upright}}},
                     {"wedge", {}, {{"level", level}, {"slope", slope}}},
                     {"weight", {}, {{"upright", upright}, {"slope", slope}}}};
  mechanism.links[1].mass_properties = {1e-9, Vector3d::Zero(), 1e-9 * Matrix3d::Identity()};
  mechanism.links[2].mass_properties = {50, Vector3d::Zero(), Matrix3d::Identity()};
  mechanism.joints = {MakeJoint("level", JointType::kPrismatic, {0, 0}, {1, 0}),
                      MakeJoint("upright", JointType::kPrismatic, {0, 1}, {2, 0}),
                      MakeJoint("slope", JointType::kPrismatic, {1, 1}, {2, 1})};
  mechanism.joints[2].load_friction.coefficient = coefficient;
  LoadStudy study;
  study.mechanism = mechanism;
  study.times = {0};
  return study;
}

PoseLoads Driven(LoadStudy study, int joint, double speed) {
  study.drives = {{joint, 0, MotionLaw::Uniform(0, speed)}};
  return RunLoadStudy(study).poses[0];
}

TEST(RestingFriction, WedgeRaisesLowersAndHoldsByTheFrictionAngle) {
  constexpr double kAngle = 0.2, kMu = 0.3;
  const double phi = std::atan(kMu);
  const LoadStudy wedge = Wedge(kAngle, kMu);
  EXPECT_NEAR(Driven(wedge, 0, 1).drives[0].force, 500 * std::tan(kAngle + phi), 500 * kExact);
  EXPECT_NEAR(Driven(wedge, 0, -1).drives[0].force, 500 * std::tan(kAngle - phi), 500 * kExact);
  const PoseLoads rest = Driven(wedge, 0, 0);
  EXPECT_NEAR(rest.drives[0].force, 0, 500 * kExact);
  EXPECT_TRUE(rest.held_by_friction);
  EXPECT_NEAR(Driven(Wedge(kAngle, 0.1), 0, 0).drives[0].force,
              500 * std::tan(kAngle - std::atan(0.1)), 500 * kExact);
}

// The weight pressed down against a force on the wedge: below the friction angle nothing moves it.
TEST(RestingFriction, WedgeThatLocksIsRecognised) {
  LoadStudy study = Wedge(0.2, 0.3);
  ExternalLoad resistance;
  resistance.link = 1;
  resistance.at = {0};
  resistance.wrenches = {{Vector3d(40, 0, 0), Vector3d::Zero()}};
  study.external = {resistance};
  study.mechanism.gravity_W.setZero();
  const PoseLoads locked = Driven(study, 1, -1);
  EXPECT_TRUE(locked.jammed);
  EXPECT_EQ(locked.locking_joint, 2);
  study.mechanism.joints[2].load_friction.coefficient = 0.1;
  const PoseLoads moving = Driven(study, 1, -1);
  EXPECT_FALSE(moving.jammed);
  EXPECT_NEAR(moving.drives[0].force, -40 / std::tan(0.2 - std::atan(0.1)), 400 * kExact);
}

/// A crank with 0.7 N m of dry friction and a load of 0.5 N m, moved through a table.
LoadStudyResult CrankThrough(const std::vector<double>& t, const std::vector<double>& angle,
                             int steps) {
  OneJoint crank(JointType::kRevolute, {});
  crank.joint.passive[0].coulomb = 0.7;
  crank.push_W.moment = {0, 0, -0.5};
  LoadStudy study = crank.Study();
  study.drives = {{0, 0, MotionLaw::Table(t, angle)}};
  study.times.clear();
  for (int i = 0; i <= steps; ++i) study.times.push_back(t.back() * i / steps);
  return RunLoadStudy(study);
}

TEST(RestingFriction, NeitherAlternatesNorExceedsWhatHoldsInADwell) {
  const LoadStudyResult result =
      CrankThrough({0, 1, 2, 3, 4, 5, 6, 7}, {0, 1, 2, 2, 2, 2, 1, 0}, 140);
  for (const PoseLoads& pose : result.poses) {
    if (pose.time < 2 || pose.time > 5) continue;
    EXPECT_EQ(pose.drives[0].velocity, 0) << pose.time;
    EXPECT_NEAR(pose.drives[0].force, 0, kExact) << pose.time;
    EXPECT_NEAR(pose.joints[0].moment.z(), 0.5, kExact) << pose.time;
  }
}

// The axial rate of a tube in a planar mechanism is rounding; it is not friction's direction.
TEST(RestingFriction, TakesRatesOfRoundingForRest) {
  LoadStudy study = StudyOf("four-bar");
  for (Joint& joint : study.mechanism.joints) {
    if (joint.type != JointType::kRevolute || joint.name == "main") continue;
    joint = MakeJoint(joint.name, JointType::kCylindrical, joint.first, joint.second);
    joint.passive[0].coulomb = 100;
    break;
  }
  const LoadStudyResult result = RunLoadStudy(study);
  for (const PoseLoads& pose : result.poses) {
    for (size_t j = 0; j < study.mechanism.joints.size(); ++j) {
      if (study.mechanism.joints[j].type != JointType::kCylindrical) continue;
      EXPECT_NEAR(pose.joints[j].force.z(), 0, 1e-6) << pose.time;
    }
  }
}

TEST(RestingFriction, IsSharedAmongTheContactsOfOneDrive) {
  LoadStudy study = StudyOf("four-bar");
  study.external.clear();
  for (Joint& joint : study.mechanism.joints) joint.load_friction = {0.2, 0.05};
  study.drives[0].law = MotionLaw::Uniform(study.drives[0].law.At(0).position, 0);
  study.times = {0};
  const LoadStudyResult result = RunLoadStudy(study);
  const PoseLoads& pose = result.poses[0];
  ASSERT_FALSE(pose.jammed);
  double friction = 0, share = 0;
  for (size_t j = 0; j < pose.joints.size(); ++j) {
    const double limit = 0.2 * 0.05 * pose.joints[j].force.head<2>().norm();
    const double moment =
        std::abs(pose.joints[j].moment.z()) -
        std::abs(pose.drives[0].force) * (study.drives[0].joint == static_cast<int>(j));
    friction = moment / limit;
    if (share == 0) share = friction;
    EXPECT_NEAR(friction, share, 1e-7) << j;
    EXPECT_LE(friction, 1 + kExact);
  }
}

}  // namespace
}  // namespace vmech
