#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "simulated.h"
#include "support/windows.h"
#include "vmech/dynamics/simulation/equilibrium.h"
#include "vmech/dynamics/simulation/modes.h"

namespace vmech {
namespace {

constexpr double kGravity = 9.81;
constexpr double kDown = -0.5 * std::numbers::pi;

/// Two point masses of 1 kg on bars of 1 m, hanging.
Simulation DoublePendulum() {
  Simulation simulation;
  Mechanism& m = simulation.mechanism;
  m = Pendulum();
  m.joints[0].start = {kDown};
  m.joints[0].start_given = true;
  m.links[1].anchors.push_back({"end", {Matrix3d::Identity(), {1, 0, 0}}});
  Link second = m.links[1];
  second.name = "second";
  m.links.push_back(second);
  m.joints.push_back(MakeJoint("elbow", JointType::kRevolute, {1, 1}, {2, 0}));
  m.joints[1].start = {0};
  simulation.times = {0, 1};
  return simulation;
}

TEST(FindModes, DoublePendulumHasTheFrequenciesOfItsClosedForm) {
  const Modes modes = FindModes(DoublePendulum());
  ASSERT_EQ(modes.modes.size(), 2U);
  EXPECT_EQ(modes.stability, Stability::kStable);
  EXPECT_LT(modes.residual, 1e-12);
  const double slow = std::sqrt((2 - std::sqrt(2)) * kGravity);
  const double fast = std::sqrt((2 + std::sqrt(2)) * kGravity);
  EXPECT_NEAR(modes.modes[0].eigenvalue.imag(), slow, 1e-9 * slow);
  EXPECT_NEAR(modes.modes[1].eigenvalue.imag(), fast, 1e-9 * fast);
  EXPECT_NEAR(modes.modes[1].frequency, fast / (2 * std::numbers::pi), 1e-9);
  // Absolute angles are as 1 : +-sqrt(2); the elbow's is the difference.
  const auto shape = modes.modes[0].shape;
  EXPECT_NEAR((shape[1] / shape[0]).real(), std::sqrt(2) - 1, 1e-9);
  EXPECT_NEAR((modes.modes[1].shape[1] / modes.modes[1].shape[0]).real(), -std::sqrt(2) - 1, 1e-9);
}

TEST(FindModes, AnUprightPendulumRunsAway) {
  Simulation simulation = DoublePendulum();
  simulation.mechanism.joints[0].start = {-kDown};
  const Modes modes = FindModes(simulation);
  EXPECT_EQ(modes.stability, Stability::kUnstable);
  EXPECT_GT(modes.modes[1].eigenvalue.real(), 0);
}

/// A four-bar of equal bars that hangs, with a torsion spring and a damper at a crank:
///   5/3 x'' + c x' + (2 g + k) x = 0.
TEST(FindModes, FourBarWithASpringAndADamper) {
  Simulation simulation;
  simulation.mechanism = Windows(1, std::numbers::pi - 0.4);
  Passive& spring = simulation.mechanism.joints[0].passive[0];
  spring.stiffness = 3;
  spring.rest = std::numbers::pi;
  simulation.start = SimulationStart::kEquilibrium;
  simulation.times = {0, 1};
  const double inertia = 5. / 3, stiffness = 2 * kGravity + 3;
  const Modes free = FindModes(simulation);
  ASSERT_EQ(free.modes.size(), 1U);
  EXPECT_NEAR(std::abs(free.modes[0].eigenvalue), std::sqrt(stiffness / inertia), 1e-9);
  spring.viscous = 0.5;
  const Modes damped = FindModes(simulation);
  const double decay = 0.5 / (2 * inertia);
  EXPECT_NEAR(damped.modes[0].eigenvalue.real(), -decay, 1e-9);
  EXPECT_NEAR(damped.modes[0].eigenvalue.imag(), std::sqrt(stiffness / inertia - decay * decay),
              1e-9);
  EXPECT_EQ(damped.stability, Stability::kStable);
}

TEST(FindEquilibrium, AMotorHoldsAPendulumOut) {
  Simulation simulation;
  simulation.mechanism = Pendulum();
  simulation.mechanism.joints[0].start = {kDown + 2.5};
  JointMotor motor;
  motor.at = {0, 0};
  motor.force = {{0}, {4}, 0};
  simulation.motors = {motor};
  simulation.times = {0, 1};
  const Equilibrium equilibrium = FindEquilibrium(simulation);
  ASSERT_TRUE(equilibrium.found) << equilibrium.message;
  EXPECT_NEAR(std::cos(equilibrium.q[0]), 4 / kGravity, 1e-12);
  EXPECT_LT(std::sin(equilibrium.q[0]), 0);  // it hangs
  EXPECT_EQ(equilibrium.stability, Stability::kStable);
}

/// Springs whose rests are such that the angles (1.1, 0.4) balance the weight: with absolute angles
/// a and b of the bars, k1 (a - rest1) = -g (2 cos a + cos b), k2 (b - a - rest2) = -g cos b.
TEST(FindEquilibrium, AStiffAndASoftSpringHoldAChainWhereTheyWereMadeFor) {
  Simulation simulation = DoublePendulum();
  const double a = 1.1, b = 1.5, soft = 40, stiff = 4e4;
  std::vector<Joint>& joints = simulation.mechanism.joints;
  joints[0].passive = {{soft, a + kGravity * (2 * std::cos(a) + std::cos(b)) / soft, 0, 0}};
  joints[1].passive = {{stiff, b - a + kGravity * std::cos(b) / stiff, 0, 0}};
  joints[1].start = {0.4 + 0.5};
  const Equilibrium equilibrium = FindEquilibrium(simulation);
  ASSERT_TRUE(equilibrium.found) << equilibrium.message;
  EXPECT_NEAR(equilibrium.q[0], a, 1e-12);
  EXPECT_NEAR(equilibrium.q[1], b - a, 1e-12);
  EXPECT_EQ(equilibrium.stability, Stability::kStable);
  EXPECT_LE(equilibrium.iterations, 20);
}

/// Where the weight has no stiffness Newton's step has no length of its own.
TEST(FindEquilibrium, APendulumFromTheHorizontalHangsWithoutATurn) {
  Simulation simulation = DoublePendulum();
  simulation.mechanism.joints[0].start = {0};
  const Equilibrium equilibrium = FindEquilibrium(simulation);
  ASSERT_TRUE(equilibrium.found) << equilibrium.message;
  EXPECT_NEAR(equilibrium.q[0], kDown, 1e-12);
  EXPECT_NEAR(equilibrium.q[1], 0, 1e-12);
  EXPECT_LE(equilibrium.iterations, 20);
}

TEST(FindEquilibrium, LeavesTheTopDownhill) {
  Simulation simulation = DoublePendulum();
  simulation.mechanism.joints[0].start = {-kDown - 1e-3};
  simulation.mechanism.joints[1].start = {2e-3};
  const Equilibrium equilibrium = FindEquilibrium(simulation);
  ASSERT_TRUE(equilibrium.found) << equilibrium.message;
  EXPECT_NEAR(std::sin(equilibrium.q[0]), -1, 1e-12);
  EXPECT_NEAR(std::cos(equilibrium.q[1]), 1, 1e-12);
  EXPECT_EQ(equilibrium.stability, Stability::kStable);
  EXPECT_LE(equilibrium.iterations, 30);
}

/// Its second bar turns about its own centre of gravity.
TEST(FindEquilibrium, ABalancedBarOnAPendulumIsNeutralAndUnstableOnTop) {
  Simulation simulation = DoublePendulum();
  simulation.mechanism.links[2].mass_properties = {1, {0, 0, 0}, 0.1 * Matrix3d::Identity()};
  EXPECT_EQ(FindEquilibrium(simulation).stability, Stability::kNeutral);
  simulation.mechanism.joints[0].start = {-kDown};
  EXPECT_EQ(FindEquilibrium(simulation).stability, Stability::kUnstable);
}

/// A weightless slider drawn along x by a stretched spring to a pin beside its guide:
/// where it is far away, the force along the guide hardly changes, and Newton's steps are too long.
TEST(FindEquilibrium, ASpringDrawsASliderBesideItsPin) {
  Simulation simulation;
  Mechanism& m = simulation.mechanism;
  m.links.resize(4);
  for (size_t i = 0; i < 4; ++i) m.links[i].name = std::string(1, static_cast<char>('a' + i));
  for (size_t i = 1; i < 4; ++i) {
    m.links[i].mass_properties = {1, {0, 0, 0}, 0.1 * Matrix3d::Identity()};
  }
  const Posed along_x{AxesFromZX(Vector3d::UnitX(), Vector3d::UnitY()), Vector3d::Zero()};
  m.links[0].anchors = {{"guide", along_x}, {"pin", {Matrix3d::Identity(), {0, 0.1, 0}}}};
  m.links[1].anchors = {{"guide", along_x}, {"eye", {}}};
  m.links[2].anchors = {{"pin", {}}, {"rod", along_x}};
  m.links[3].anchors = {{"rod", along_x}, {"eye", {}}};
  m.joints = {MakeJoint("guide", JointType::kPrismatic, {0, 0}, {1, 0}),
              MakeJoint("pin", JointType::kRevolute, {0, 1}, {2, 0}),
              MakeJoint("rod", JointType::kPrismatic, {2, 1}, {3, 0}),
              MakeJoint("eye", JointType::kRevolute, {3, 1}, {1, 1})};
  m.joints[0].start = {1};
  m.joints[1].start = {std::atan2(-0.1, 1)};
  m.joints[2].start = {std::hypot(0.1, 1)};
  m.joints[0].start_given = m.joints[1].start_given = m.joints[2].start_given = true;
  m.joints[2].passive = {{1, -100, 0, 0}};
  simulation.times = {0, 1};
  const Equilibrium equilibrium = FindEquilibrium(simulation);
  ASSERT_TRUE(equilibrium.found) << equilibrium.message;
  EXPECT_NEAR(equilibrium.q[0], 0, 1e-12);
  EXPECT_EQ(equilibrium.stability, Stability::kStable);
}

TEST(Simulate, StaysAtAnEquilibriumThatItStartsFrom) {
  Simulation simulation;
  simulation.mechanism = Windows(2, 2.6);
  simulation.start = SimulationStart::kEquilibrium;
  simulation.times = {0, 2};
  const SimulationResult result = Simulate(simulation);
  EXPECT_LT((result.Q(1) - result.Q(0)).cwiseAbs().maxCoeff(), 1e-8);
}

TEST(FindEquilibrium, SaysWhereThereIsNone) {
  Simulation simulation;
  simulation.mechanism = Block({0, 0, 1});
  simulation.times = {0, 1};
  const Equilibrium equilibrium = FindEquilibrium(simulation);
  EXPECT_FALSE(equilibrium.found);
  EXPECT_NE(equilibrium.message.find("no equilibrium"), std::string::npos);
}

TEST(FindModes, DampersMakeAMotionDieAway) {
  Simulation simulation;
  simulation.mechanism = Pendulum();
  simulation.mechanism.joints[0].start = {kDown};
  simulation.mechanism.joints[0].start_given = true;
  simulation.mechanism.joints[0].passive = {{0, 0, 0.5, 0}};
  simulation.times = {0, 1};
  const Modes modes = FindModes(simulation);
  ASSERT_EQ(modes.modes.size(), 1U);
  EXPECT_EQ(modes.stability, Stability::kStable);
  EXPECT_NEAR(modes.modes[0].damping_ratio, 0.5 / (2 * std::sqrt(kGravity)), 1e-9);
  EXPECT_NEAR(modes.modes[0].eigenvalue.real(), -0.25, 1e-9);
}

}  // namespace
}  // namespace vmech
