#include "vmech/dynamics/rigid_body/passive.h"
#include "vmech/dynamics/loads/load_result.h"
#include "vmech/dynamics/loads/run_load_study.h"

#include <gtest/gtest.h>

#include <cmath>

#include "driven_examples.h"

namespace vmech {
namespace {

constexpr double kRounding = 1e-11;

/// One pose at the start of a joint, which moves as given.
LoadStudy AtStart(const Mechanism& mechanism, const std::string& joint, double velocity,
                  double acceleration = 0) {
  LoadStudy study;
  study.mechanism = mechanism;
  const int index = FindJoint(mechanism, joint);
  study.drives = {
      {index, 0, MotionLaw::Uniform(mechanism.joints[index].start[0], velocity, acceleration)}};
  study.times = {0};
  return study;
}

TEST(DryFriction, IsOvercomeByTheMotorWhicheverWayItTurns) {
  constexpr double kWithout = 1.02178751843966;  // [N m] m c g cos q + I q'', see crank.yaml
  constexpr double kMoment = 0.7;
  Mechanism crank = Example("crank");
  crank.joints[0].passive[0].coulomb = kMoment;
  auto moment = [&](double velocity) {
    return RunLoadStudy(AtStart(crank, "main", velocity, 5)).poses[0].drives[0].force;
  };
  EXPECT_NEAR(moment(3), kWithout + kMoment, kRounding);
  EXPECT_NEAR(moment(-3), kWithout - kMoment, kRounding);
  EXPECT_NEAR(moment(0), kWithout - kMoment, kRounding);  // at rest it holds what it can
  crank.joints[0].passive[0].coulomb = 2 * kWithout;
  EXPECT_NEAR(moment(0), 0, kRounding);
}

/// A block of 2 kg that slides along a level track.
Mechanism Sledge(double coefficient) {
  Mechanism mechanism;
  mechanism.gravity_W = {0, -9.81, 0};
  const Posed along_x{AxesFromZX(Vector3d::UnitX(), Vector3d::UnitY()), Vector3d::Zero()};
  mechanism.links = {{"ground", {}, {{"track", along_x}}}, {"sledge", {}, {{"track", along_x}}}};
  mechanism.links[1].mass_properties.mass = 2;
  mechanism.links[1].mass_properties.I_Lcm.setIdentity();
  mechanism.joints = {MakeJoint("track", JointType::kPrismatic, {0, 0}, {1, 0})};
  mechanism.joints[0].load_friction.coefficient = coefficient;
  return mechanism;
}

TEST(LoadFriction, OfASledgeIsInProportionToItsWeight) {
  const PoseLoads pose = RunLoadStudy(AtStart(Sledge(0.25), "track", 1, 3)).poses[0];
  EXPECT_NEAR(pose.drives[0].force, 2 * 3 + 0.25 * 2 * 9.81, kRounding);
  EXPECT_NEAR(pose.joints[0].force.z(), 2 * 3, kRounding);  // drive less friction moves the mass
}

/// A slider-crank without weight whose slider is pushed against its crank by kPush.
class WeightlessSliderCrank : public testing::Test {
 protected:
  static constexpr double kPush = 200;  // [N]
  static constexpr double kCrank = 0.05, kRod = 0.15;

  WeightlessSliderCrank() : mechanism_(Example("slider-crank")) {
    mechanism_.gravity_W.setZero();
    for (Link& link : mechanism_.links) link.mass_properties = {};
    q_ = mechanism_.joints[FindJoint(mechanism_, "main")].start[0];
    phi_ = std::asin(kCrank * std::sin(q_) / kRod);
  }

  PoseLoads With(double coefficient, double crank_speed) {
    mechanism_.joints[FindJoint(mechanism_, "guide")].load_friction.coefficient = coefficient;
    LoadStudy study = AtStart(mechanism_, "main", crank_speed);
    ExternalLoad push;
    push.link = FindLink(mechanism_, "slider");
    push.at = {0};
    push.wrenches = {{Vector3d(-kPush, 0, 0), Vector3d::Zero()}};
    study.external = {push};
    return RunLoadStudy(study).poses[0];
  }

  /// Moment about the crank's bearing of a force P along the rod.
  double MomentOf(double P) const { return P * kCrank * std::sin(q_ + phi_); }

  Mechanism mechanism_;
  double q_, phi_;
};

// Along the slide P cos(phi) = F + mu N, across it N = P sin(phi), while the slider goes out.
TEST_F(WeightlessSliderCrank, DrivesItsLoadAgainstFrictionThatTheLoadCauses) {
  constexpr double kMu = 0.3;
  const PoseLoads pose = With(kMu, -2);
  const double P = kPush / (std::cos(phi_) - kMu * std::sin(phi_));
  EXPECT_NEAR(pose.drives[0].force, -MomentOf(P), kRounding * kPush);
  const Wrenchd& guide = pose.joints[FindJoint(mechanism_, "guide")];
  EXPECT_NEAR(std::abs(guide.force.x()), P * std::sin(phi_), kRounding * kPush);
  EXPECT_NEAR(guide.force.z(), -kMu * P * std::sin(phi_), kRounding * kPush);
  EXPECT_LE(pose.power_error, kRounding);
  EXPECT_FALSE(pose.jammed);
}

// Giving way has an equilibrium whatever the friction, also beyond the cone that locks the other
// way.
TEST_F(WeightlessSliderCrank, IsHelpedByFrictionAsItGivesWay) {
  for (const double mu : {0.3, 1.5 / std::tan(phi_)}) {
    const PoseLoads pose = With(mu, 2);
    const double P = kPush / (std::cos(phi_) + mu * std::sin(phi_));
    EXPECT_NEAR(pose.drives[0].force, -MomentOf(P), kRounding * kPush);
    EXPECT_FALSE(pose.jammed);
  }
}

// With mu tan(phi) > 1 any force of the rod presses the slider into its guide harder than it pushes
// it along.
TEST_F(WeightlessSliderCrank, LocksWhereTheRodLeansMoreThanTheFrictionCone) {
  const double limit = 1 / std::tan(phi_);
  EXPECT_FALSE(With(0.99 * limit, -2).jammed);
  EXPECT_TRUE(With(1.1 * limit, -2).jammed);
}

/// A four-bar with a spring and all kinds of friction at its output.
LoadStudy BrakedFourBar() {
  LoadStudy study = StudyOf("four-bar");
  Joint& pivot = study.mechanism.joints[FindJoint(study.mechanism, "rocker_pivot")];
  pivot.passive[0] = {30, 0.2, 2, 1.5};
  pivot.load_friction = {0.1, 0.02};
  return study;
}

TEST(Passive, ActsAlikeInACutJointAndInAWholeOne) {
  LoadStudy study = BrakedFourBar();
  study.mechanism.preferred_cuts = {FindJoint(study.mechanism, "rocker_pivot")};
  const LoadStudyResult cut = RunLoadStudy(study);
  study.mechanism.preferred_cuts = {FindJoint(study.mechanism, "rocker_pin")};
  const LoadStudyResult whole = RunLoadStudy(study);
  ASSERT_EQ(cut.cut_joints, std::vector<std::string>{"rocker_pivot"});
  ASSERT_EQ(whole.cut_joints, std::vector<std::string>{"rocker_pin"});
  EXPECT_LE(RelativeDifference(study.mechanism, cut, whole), 1e-9);
  EXPECT_LE(cut.max_power_error, 1e-9);
  EXPECT_LE(whole.max_power_error, 1e-9);
}

TEST(Passive, TakesItsPowerFromTheDrive) {
  LoadStudy study = StudyOf("four-bar");
  const LoadStudyResult without = RunLoadStudy(study);
  const int pivot = FindJoint(study.mechanism, "rocker_pivot");
  const Passive passive{30, 0.2, 2, 1.5};
  study.mechanism.joints[pivot].passive[0] = passive;
  const LoadStudyResult with = RunLoadStudy(study);
  for (size_t i = 0; i < with.poses.size(); ++i) {
    const double q = with.poses[i].joints[pivot].position[0];
    const double rate = with.poses[i].joints[pivot].rate[0];
    const double force = 30 * (q - 0.2) + 2 * rate + std::copysign(1.5, rate);
    const double power = with.poses[i].power - without.poses[i].power;
    EXPECT_NEAR(power, force * rate, 1e-9 * (1 + std::abs(with.poses[i].power)));
  }
}

}  // namespace
}  // namespace vmech
