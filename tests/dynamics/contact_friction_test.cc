#include "vmech/dynamics/loads/pose/contact_friction.h"
#include "vmech/dynamics/loads/load_result.h"
#include "vmech/dynamics/loads/run_load_study.h"

#include <gmock/gmock.h>

#include <cmath>
#include <numbers>
#include <random>

#include "one_joint.h"

namespace vmech {
namespace {

using testing::HasSubstr;

constexpr double kExact = 1e-9;  // relative, of closed forms
constexpr double kMu = 0.3;
constexpr double kTurns[] = {0, std::numbers::pi / 8, std::numbers::pi / 4, 1.9, -2.6};

/// 10 kg on a level table.
OneJoint Block(double turn) {
  OneJoint block(JointType::kPlanar, {kMu, 0.05});
  block.turn = turn;
  block.gravity_W = {0, 0, -10};
  return block;
}

/// A velocity along the world's x axis in the axes of anchors turned about z.
std::vector<double> AlongX(double speed, double turn, double spin) {
  return {speed * std::cos(turn), -speed * std::sin(turn), spin};
}

TEST(ContactFriction, OfADraggedBlockIsAgainstItsVelocityHoweverItsAnchorLies) {
  for (const double turn : kTurns) {
    const auto force = DriveForces(Block(turn).At(AlongX(1, turn, 0)));
    const Vector3d f_W =
        Eigen::AngleAxisd(turn, Vector3d::UnitZ()) * Vector3d(force[0], force[1], 0);
    EXPECT_LE((f_W - Vector3d(30, 0, 0)).norm(), 30 * kExact) << turn;
    EXPECT_NEAR(force[2], 0, 30 * kExact);
  }
}

// One contact: the sliding velocity is (v_x, v_y, r w).
TEST(ContactFriction, OfABlockThatSlidesAndSpinsIsSharedAsItsVelocityIs) {
  constexpr double kSpeed = 0.3, kSpin = 8, kRadius = 0.05;
  const double slip = std::hypot(kSpeed, kRadius * kSpin);
  for (const double turn : kTurns) {
    const auto force = DriveForces(Block(turn).At(AlongX(kSpeed, turn, kSpin)));
    EXPECT_NEAR(std::hypot(force[0], force[1]), 30 * kSpeed / slip, 30 * kExact);
    EXPECT_NEAR(force[2], 30 * kRadius * kRadius * kSpin / slip, 30 * kExact);
  }
}

TEST(ContactFriction, ThatIsConstantIsAVectorAsWell) {
  for (const double turn : kTurns) {
    OneJoint block(JointType::kPlanar, {});
    block.turn = turn;
    block.joint.passive[0].coulomb = block.joint.passive[1].coulomb = 12;
    const auto force = DriveForces(block.At(AlongX(-2, turn, 0)));
    EXPECT_NEAR(std::hypot(force[0], force[1]), 12, 12 * kExact);
    EXPECT_NEAR(force[0] * std::cos(turn) - force[1] * std::sin(turn), -12, 12 * kExact);
  }
}

TEST(ContactFriction, OfATubeThatShiftsAndTurnsIsOneVector) {
  constexpr double kShift = 0.3, kSpin = -4, kRadius = 0.02;
  const double slip = std::hypot(kShift, kRadius * kSpin);
  for (const double turn : kTurns) {
    OneJoint tube(JointType::kCylindrical, {kMu, kRadius});
    tube.turn = turn;
    tube.push_W.force = {60, -80, 0};
    const auto force = DriveForces(tube.At({kShift, kSpin}));
    EXPECT_NEAR(force[0], kMu * 100 * kShift / slip, 100 * kExact);
    EXPECT_NEAR(force[1], kMu * 100 * kRadius * kRadius * kSpin / slip, 100 * kExact);
  }
}

// Supports at +-l/2 carry F/2 +- (z x M)/l, here (30, 40) +- (5, 10) N.
const Wrenchd kSideAndCouple{{60, 80, 25}, {2, -1, 0}};
constexpr double kLength = 0.2;
const double kSupports = std::hypot(35, 50) + std::hypot(25, 30);

TEST(ContactFriction, OfAPinCountsThrustAndCouple) {
  for (const double turn : kTurns) {
    OneJoint pin(JointType::kRevolute, {kMu, 0.01, 0.015, kLength});
    pin.turn = turn;
    pin.push_W = kSideAndCouple;
    const LoadStudyResult result = pin.At({-3});
    const double moment = kMu * (0.01 * kSupports + 0.015 * 25);
    EXPECT_NEAR(DriveForces(result)[0], -moment, moment * kExact);
    EXPECT_NEAR(result.poses[0].joints[0].moment.z(), 0, moment * kExact);
    EXPECT_THAT(result.warnings, testing::IsEmpty());
  }
}

TEST(ContactFriction, OfASlideCountsCoupleAndTorque) {
  for (const double turn : kTurns) {
    OneJoint slide(JointType::kPrismatic, {kMu, 0, 0, kLength, 0.04});
    slide.turn = turn;
    slide.push_W = kSideAndCouple;
    slide.push_W.force.z() = 0;
    slide.push_W.moment.z() = -1.5;
    const double force = kMu * (kSupports + 2 * 1.5 / 0.04);
    EXPECT_NEAR(DriveForces(slide.At({2}))[0], force, force * kExact);
  }
}

// Each pin is loaded by what lies across its own axis, and in thrust by what lies along it.
TEST(ContactFriction, OfAUniversalJointIsThatOfItsTwoPins) {
  constexpr double kRadius = 0.01, kThrust = 0.006, kAngle = 0.7;
  OneJoint cross(JointType::kUniversal, {kMu, kRadius, kThrust});
  cross.joint.start = {kAngle, 0};
  cross.push_W.force = {30, 0, 40};
  const auto force = DriveForces(cross.At({2, -5}));
  const double along = 40 * std::sin(kAngle);  // of the second pin, (0, cos, sin)
  const double first = kMu * (kRadius * 40 + kThrust * 30);
  const double second = kMu * (kRadius * std::hypot(30, 40 * std::cos(kAngle)) + kThrust * along);
  EXPECT_NEAR(force[0], first, first * kExact);
  EXPECT_NEAR(force[1], -second, second * kExact);
}

/// A hand that turns the body about an axis at 1 rad/s; returns its moment.
Vector3d MomentOfHand(const OneJoint& ball, const Vector3d& axis) {
  LoadStudy study = ball.Study();
  const Posed turned{Eigen::AngleAxisd(0.1, axis).toRotationMatrix(), Vector3d::Zero()};
  study.hand = HandDrive{0, HandLaw::Table({0, 0.1}, {Posed(), turned}), Vector6d::Zero()};
  return RunLoadStudy(study).poses[0].hand.moment;
}

TEST(ContactFriction, OfABallIsAgainstItsAngularVelocity) {
  const Vector3d axis = Vector3d(1, -2, 3).normalized();
  for (const double turn : kTurns) {
    OneJoint ball(JointType::kSpherical, {kMu, 0.02});
    ball.turn = turn;
    ball.push_W.force = {20, 40, -40};
    const double moment = kMu * 0.02 * 60;
    EXPECT_LE((MomentOfHand(ball, axis) - moment * axis).norm(), moment * kExact);
  }
}

/// A screw jack under 2000 N: 6 mm in a turn, mean radius 12 mm.
OneJoint Jack(double coefficient, double pitch_per_turn = 0.006) {
  OneJoint jack(JointType::kScrew, {coefficient, 0.012});
  jack.joint.pitch = pitch_per_turn / (2 * std::numbers::pi);
  jack.push_W.force = {0, 0, -2000};
  return jack;
}

double TorqueOfThread(double coefficient, double pitch_per_turn, double sense) {
  const double lead = std::atan(pitch_per_turn / (2 * std::numbers::pi) / 0.012);
  return 2000 * 0.012 * std::tan(lead + sense * std::atan(coefficient));
}

TEST(ContactFriction, OfAThreadRaisesAndLowersByLeadAndFrictionAngle) {
  EXPECT_NEAR(DriveForces(Jack(0.15).At({1}))[0], 5.576, 5e-4);
  for (const double mu : {0.02, 0.15, 0.6}) {
    for (const double pitch : {0.006, -0.006, 0.05}) {
      const double sense = pitch > 0 ? 1 : -1;
      const double raising = TorqueOfThread(mu, pitch, sense);
      const double lowering = TorqueOfThread(mu, pitch, -sense);
      EXPECT_NEAR(DriveForces(Jack(mu, pitch).At({sense}))[0], raising, 10 * kExact);
      EXPECT_NEAR(DriveForces(Jack(mu, pitch).At({-sense}))[0], lowering, 10 * kExact);
    }
  }
}

TEST(ContactFriction, OfAThreadTakesItsRadialLoadAsAPinDoes) {
  OneJoint jack = Jack(0.15);
  const double alone = DriveForces(jack.At({1}))[0];
  jack.push_W.force.x() = 300;
  EXPECT_NEAR(DriveForces(jack.At({1}))[0], alone + 0.15 * 0.012 * 300, 10 * kExact);
}

// Lead angle 59 degrees, friction angle 35 degrees: no torque raises it.
TEST(ContactFriction, LocksASteepThreadAgainstRaising) {
  const LoadStudyResult raising = Jack(0.7, 0.125).At({1});
  EXPECT_TRUE(raising.poses[0].jammed);
  EXPECT_THAT(raising.warnings, testing::Contains(HasSubstr("by joint 'joint'")));
  EXPECT_FALSE(Jack(0.7, 0.125).At({-1}).poses[0].jammed);
  EXPECT_FALSE(Jack(0.5, 0.125).At({1}).poses[0].jammed);
}

TEST(ContactFriction, RecognisesASelfLockingScrew) {
  EXPECT_THAT(Jack(0.15).At({1}).warnings, testing::Contains(HasSubstr("is self-locking")));
  EXPECT_THAT(Jack(0.07).At({1}).warnings, testing::IsEmpty());
}

TEST(ContactFriction, NeverDrivesTheMechanism) {
  std::mt19937 random(7);
  std::normal_distribution<double> normal;
  const auto vector = [&] { return Vector3d(normal(random), normal(random), normal(random)); };
  for (const JointType type :
       {JointType::kRevolute, JointType::kPrismatic, JointType::kCylindrical, JointType::kScrew,
        JointType::kUniversal, JointType::kSpherical, JointType::kPlanar}) {
    Joint joint = OneJoint(type, {kMu, 0.2, 0.3, 0.4, 0.5}).joint;
    joint.pitch = 0.1;
    for (Passive& passive : joint.passive) passive.coulomb = std::abs(normal(random));
    for (int i = 0; i < 200; ++i) {
      Vector3d rate = vector();
      rate.tail(3 - FreedomsOf(type)).setZero();
      const Vector3d limits = FrictionLimits(joint, {vector(), vector()}, vector(), rate);
      EXPECT_LT(SlidingFriction<double>(type, limits, rate).dot(rate), 0);
    }
  }
}

TEST(ContactFriction, SaysWhichLoadItDoesNotCount) {
  OneJoint pin(JointType::kRevolute, {kMu, 0.01});
  pin.push_W = kSideAndCouple;
  EXPECT_THAT(pin.At({1}).warnings,
              testing::UnorderedElementsAre(
                  HasSubstr("joint 'joint': its friction does not count the thrust of up to 25 N"),
                  HasSubstr("the tilting couple of up to 2.236 N m; give 'length'")));
  OneJoint slide(JointType::kPrismatic, {kMu, 0, 0, kLength});
  slide.push_W.moment.z() = 3;
  EXPECT_THAT(slide.At({1}).warnings,
              testing::ElementsAre(HasSubstr("the torque about the slide of up to 3 N m")));
  OneJoint block = Block(0);
  EXPECT_THAT(block.At({1, 0, 0}).warnings, testing::IsEmpty());
  block.push_W.moment = {0, 100, 0};  // the weight at 50 mm holds 5 N m
  EXPECT_THAT(block.At({1, 0, 0}).warnings, testing::ElementsAre(HasSubstr("tilts the contact")));
}

}  // namespace
}  // namespace vmech
