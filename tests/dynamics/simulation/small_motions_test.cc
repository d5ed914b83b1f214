#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

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
