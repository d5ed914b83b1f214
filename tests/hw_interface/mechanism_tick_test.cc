#include "vmech/hw_interface/rendering/mechanism_tick.h"
#include "hw_interface/tick_input.h"

#include <gtest/gtest.h>

#include <numbers>

#include "support/examples.h"
#include "vmech/base/rotation_error.h"
#include "vmech/kinematics/loops/assembly.h"
#include "vmech/kinematics/tree/forward_kinematics.h"

namespace vmech::mechanism_tick_test {
namespace {

constexpr double kPeriod = 1e-3;

DeviceInfo FineDevice() {
  DeviceInfo info;
  info.period = kPeriod;
  return info;
}

ContactLaw Spring(double stiffness) {
  ContactLaw law;
  law.stiffness << stiffness, stiffness, stiffness, 0.0025 * stiffness, 0.0025 * stiffness,
      0.0025 * stiffness;
  return law;
}

/// A mechanism in a hand, without a device.
struct Held {
  Held(const Mechanism& mechanism, const std::string& grasp, MechanismTickOptions options)
      : tree(BuildKinematicTree(mechanism)),
        tick(tree, FindGrasp(mechanism, grasp), ClosedStart(tree), FineDevice(), options),
        start(tick.GraspFrame()),
        channels(tick.ChannelNames().size()) {}

  TickOutput Step(const Posed& X_WH) {
    const TickOutput out = tick.Step(FreshInput(X_WH, kPeriod), channels);
    EXPECT_NE(out.status, TickStatus::kFailed);
    return out;
  }
  TickOutput Rest(const Posed& X_WH) {
    for (int k = 0; k < 300; ++k) Step(X_WH);
    return Step(X_WH);
  }

  KinematicTree tree;
  MechanismTick tick;
  Posed start;
  std::vector<double> channels;
};

MechanismTickOptions With(const ContactLaw& law) {
  MechanismTickOptions options;
  options.law = law;
  return options;
}

TEST(MechanismTick, HandAtRestFeelsTheGravityShare) {
  Held held(Example("crank"), "tip", With(Spring(500)));
  const Vector6d F = held.Rest(held.start).F_Ho_W;
  // The weight's moment about the pin over the crank's length, across the crank, downwards.
  const double angle = 40 * std::numbers::pi / 180;
  const double size = 0.8 * 9.81 * 0.15 * std::cos(angle) / 0.3;
  EXPECT_NEAR(F[0], size * std::sin(angle), 1e-6);
  EXPECT_NEAR(F[1], -size * std::cos(angle), 1e-6);
}

TEST(MechanismTick, HandPulledOffIsPulledBack) {
  Mechanism crank = Example("crank");
  crank.gravity_W.setZero();
  Held held(crank, "tip", With(Spring(500)));
  Posed X_WH = held.start;
  const Vector3d outwards = held.start.p.normalized();
  X_WH.p += 0.01 * outwards;
  const Vector6d F = held.Rest(X_WH).F_Ho_W;
  EXPECT_LT((F.head<3>() + 5 * outwards).norm(), 1e-6);
  EXPECT_EQ(F.tail<3>().norm(), 0);  // a point grasp
}

TEST(MechanismTick, FreeMotionFeelsNoConstraint) {
  Mechanism four_bar = Example("four-bar");
  four_bar.gravity_W.setZero();
  Held held(four_bar, "handle", With(Spring(500)));
  Posed X_WH = held.start;
  X_WH.p += Vector3d(0.01, -0.02, 0.015);
  X_WH.R = Eigen::AngleAxisd(0.1, Vector3d(1, 2, -1).normalized()).toRotationMatrix() * X_WH.R;
  const Vector6d w_c = -held.Rest(X_WH).F_Ho_W;
  EXPECT_GT(w_c.norm(), 1);
  // The one motion that the four-bar allows here.
  HandDynamics dynamics(held.tree, GraspFrameOf(held.tree, 0), Spring(500).stiffness,
                        held.tick.q());
  const Posed X_WG = dynamics.SetPose(held.tick.q());
  ASSERT_TRUE(dynamics.Evaluate(Vector6d::Ones(), Vector6d::Zero()));
  VectorXd q = held.tick.q();
  constexpr double kStep = 1e-6;
  MoveCoordinates(held.tree, kStep * dynamics.v(), &q);
  const Vector6d V = HandError(X_WG, dynamics.SetPose(q)) / kStep;
  EXPECT_LT(std::abs(w_c.dot(V)), 1e-5 * w_c.norm() * V.norm());
}

TEST(MechanismTick, FeltInertiaIsTheTrueOneBelow3Hertz) {
  Mechanism crank = Example("crank");
  crank.gravity_W.setZero();
  Held held(crank, "tip", With(Spring(500)));
  const double inertia = 0.006 + 0.8 * 0.15 * 0.15;  // about the pin
  constexpr double kHertz = 2.5, kSwing = 0.2;
  const double rate = 2 * std::numbers::pi * kHertz;
  const double count = 2 * std::numbers::pi / 65536;
  double along = 0, size = 0;
  for (int k = 0; k < 3000; ++k) {
    const double phase = rate * k * kPeriod;
    const double swing = count * std::round(kSwing * std::sin(phase) / count);
    const Matrix3d R = Eigen::AngleAxisd(swing, Vector3d::UnitZ()).toRotationMatrix();
    const Vector3d p = R * held.start.p;
    const Vector6d F = held.Step({R * held.start.R, p}).F_Ho_W;
    if (k < 1000) continue;
    const double moment = p.cross(-F.head<3>()).z();
    const double acceleration = -kSwing * rate * rate * std::sin(phase);
    along += moment * acceleration;
    size += acceleration * acceleration;
  }
  EXPECT_NEAR(along / size, inertia, 0.05 * inertia);
}

TEST(MechanismTick, RefusesAGraspThatLeavesALinkLoose) {
  Mechanism arm = Example("two-link-arm");
  arm.grasps[FindGrasp(arm, "handle")].link = FindLink(arm, "upper-arm");
  EXPECT_THROW(Held(arm, "handle", With(Spring(500))), std::invalid_argument);
}

}  // namespace
}  // namespace vmech::mechanism_tick_test
