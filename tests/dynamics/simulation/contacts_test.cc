#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "simulated.h"

namespace vmech {
namespace {

using Kind = SimulationEvent::Kind;
constexpr double kGravity = 9.81;

std::vector<double> Times(double end, int steps) {
  std::vector<double> times;
  for (int i = 0; i <= steps; ++i) times.push_back(end * i / steps);
  return times;
}

/// A pendulum that falls on a stop a radian below the horizontal.
Simulation BouncingPendulum(double restitution) {
  Simulation simulation;
  simulation.mechanism = Pendulum();
  simulation.mechanism.joints[0].lower = {-1};
  simulation.rebounds = {{{0, 0}, restitution}};
  simulation.times = Times(6, 60);
  return simulation;
}

TEST(Contacts, ABouncingPendulumKeepsRestitutionsLawUntilItRests) {
  SimulationOptions options = Tight(1e-14);
  options.absolute_tolerance = 1e-15;  // for flights of micrometres
  const SimulationResult result = Simulate(BouncingPendulum(0.6), options);
  ASSERT_EQ(result.status, SimulationStatus::kFinished) << result.message;
  // Energy is kept between impacts: it comes back as fast as it left.
  double rate = -std::sqrt(2 * kGravity * std::sin(1));
  size_t bounces = 0;
  for (const SimulationEvent& event : result.events) {
    if (event.kind != Kind::kRebound) continue;
    EXPECT_NEAR(event.rate * event.rate, rate * rate, 1e-11) << bounces;
    if (rate < -0.01) EXPECT_NEAR(event.rate, rate, 1e-9) << bounces;
    rate *= 0.6;
    ++bounces;
  }
  EXPECT_GT(bounces, 20U);
  EXPECT_EQ(result.events.back().kind, Kind::kLimitCloses);
  EXPECT_NEAR(result.Q(60)[0], -1, 1e-9);
  EXPECT_EQ(result.V(60)[0], 0);
  EXPECT_NEAR(result.energies.back().dissipated, kGravity * std::sin(1), 1e-8);
}

TEST(Contacts, AStopHoldsAndLetsGo) {
  Simulation simulation;
  simulation.mechanism = Block({0, 0, 1});
  simulation.mechanism.joints[0].lower = {0};
  JointMotor lift;
  lift.at = {0, 0};
  lift.force = {{0, 1}, {0, 40}, 0};
  simulation.motors = {lift};
  simulation.times = {0, 0.25, 1};
  const SimulationResult result = Simulate(simulation, Tight(1e-12));
  // 2 kg leave the stop when 40 t N carry them.
  ASSERT_EQ(result.events.size(), 2U);
  EXPECT_EQ(result.events[0].kind, Kind::kLimitCloses);
  EXPECT_EQ(result.events[1].kind, Kind::kLimitOpens);
  const double leaves = 2 * kGravity / 40, t = 1 - leaves;
  EXPECT_NEAR(result.events[1].time, leaves, 1e-9);
  EXPECT_EQ(result.V(1)[0], 0);
  EXPECT_NEAR(result.Q(2)[0], 40 / 2. * t * t * t / 6, 1e-9);
  // The joint's free component is what the stop and the motor exert.
  EXPECT_NEAR(result.loads.poses[1].joints[0].force.z(), 2 * kGravity, 1e-9);
}

TEST(Contacts, AnImpactThatTakesAllSpeedIsToldWhereNothingStays) {
  // Thrown up at 3 m/s against a ceiling 0.2 m above, where it stops dead and falls.
  Simulation simulation;
  simulation.mechanism = Block({0, 0, 1});
  simulation.mechanism.joints[0].upper = {0.2};
  simulation.start_rates = {{{0, 0}, 3}};
  simulation.times = {0, 0.3};
  const SimulationResult result = Simulate(simulation, Tight(1e-12));
  ASSERT_EQ(result.events.size(), 1U);
  const SimulationEvent& impact = result.events[0];
  EXPECT_EQ(impact.kind, Kind::kRebound);
  const double speed = std::sqrt(9 - 2 * kGravity * 0.2), hit = (3 - speed) / kGravity;
  EXPECT_NEAR(impact.time, hit, 1e-9);
  EXPECT_NEAR(impact.rate, speed, 1e-9);
  EXPECT_NEAR(result.Q(1)[0], 0.2 - kGravity * (0.3 - hit) * (0.3 - hit) / 2, 1e-9);
}

/// Of all components of all joints.
int CountCertain(const SimulationResult& result) {
  int count = 0;
  for (const JointCertainty& verdicts : result.loads.certainty) {
    count += static_cast<int>(std::count(verdicts.begin(), verdicts.end(), Certainty::kCertain));
  }
  return count;
}

SimulationResult OnSlope(double angle, double coefficient) {
  Simulation simulation;
  simulation.mechanism = Block({std::cos(angle), 0, -std::sin(angle)});
  simulation.mechanism.joints[0].load_friction.coefficient = coefficient;
  simulation.times = {0, 1};
  return Simulate(simulation, Tight(1e-12));
}

TEST(Contacts, ABlockSticksBelowTheFrictionAngleAndSlidesAboveIt) {
  const double friction_angle = std::atan(0.4);
  const SimulationResult sticks = OnSlope(friction_angle - 1e-6, 0.4);
  EXPECT_EQ(sticks.Q(1)[0], 0);
  EXPECT_EQ(sticks.events.front().kind, Kind::kSticks);
  EXPECT_EQ(CountCertain(sticks), 6);
  const double steeper = friction_angle + 0.1;
  const SimulationResult slides = OnSlope(steeper, 0.4);
  const double acceleration = kGravity * (std::sin(steeper) - 0.4 * std::cos(steeper));
  EXPECT_NEAR(slides.Q(1)[0], 0.5 * acceleration, 1e-9);
  EXPECT_NEAR(slides.Vdot(1)[0], acceleration, 1e-9);
  EXPECT_NEAR(slides.energies[1].error, 0, 1e-8);
}

TEST(Contacts, ADoorWithFrictionComesToRestAndStays) {
  Simulation simulation;
  simulation.mechanism = Pendulum(3);  // 3 kg m^2 about its pin
  simulation.mechanism.gravity_W.setZero();
  simulation.mechanism.joints[0].passive[0].coulomb = 1.5;
  simulation.start_rates = {{{0, 0}, 2}};
  simulation.times = {0, 2, 6, 10};
  const SimulationResult result = Simulate(simulation, Tight(1e-12));
  // It slows down by 0.5 rad/s^2.
  ASSERT_EQ(result.events.size(), 1U);
  EXPECT_EQ(result.events[0].kind, Kind::kSticks);
  EXPECT_NEAR(result.events[0].time, 4, 1e-9);
  EXPECT_NEAR(result.Q(1)[0], 3, 1e-9);
  EXPECT_NEAR(result.Q(2)[0], 4, 1e-9);
  EXPECT_EQ(result.Q(3)[0], result.Q(2)[0]);
  EXPECT_NEAR(result.energies.back().dissipated, 6, 1e-9);
}

/// Two joints that hold one freedom share it; which of them does what statics leaves open, but not
/// when it moves.
TEST(Contacts, AMechanismSlipsWhereAllItsFrictionIsSpent) {
  Simulation simulation;
  simulation.mechanism = Example("four-bar");
  simulation.mechanism.gravity_W.setZero();
  const int crank = 0;
  for (Joint& joint : simulation.mechanism.joints) joint.passive[0].coulomb = 0.2;
  JointMotor motor;
  motor.at = {crank, 0};
  motor.force = {{0, 10}, {0, 20}, 0};
  simulation.motors = {motor};
  simulation.times = {0, 1};
  const SimulationResult result = Simulate(simulation);
  // A virtual turn of the crank turns every joint by its ratio: their friction adds up.
  double ratios = 0;
  const LoadArrays& loads = result.loads.poses.arrays();
  Simulation free = simulation;
  for (Joint& joint : free.mechanism.joints) joint.passive[0].coulomb = 0;
  free.motors.clear();
  free.start_rates = {{{crank, 0}, 1}};
  const SimulationResult turning = Simulate(free);
  for (size_t j = 0; j < loads.joint_count(); ++j) {
    ratios += std::abs(turning.loads.poses.front().joints[j].rate[0]);
  }
  const auto slips = std::find_if(result.events.begin(), result.events.end(),
                                  [](const auto& event) { return event.kind == Kind::kSlips; });
  ASSERT_NE(slips, result.events.end());
  EXPECT_NEAR(2 * slips->time, 0.2 * ratios, 1e-8);
  EXPECT_EQ(CountCertain(result), 0);
  EXPECT_EQ(result.warnings.size(), 1U);
  EXPECT_GT(CountCertain(turning), 0);
}

/// Friction of a linkage that is overconstrained across its plane goes with loads that no statics
/// tells: with another rule the mechanism moves otherwise, and nothing is certain.
TEST(Contacts, FrictionUnderOpenLoadsLeavesNothingCertain) {
  Simulation simulation;
  simulation.mechanism = Example("four-bar");
  simulation.mechanism.gravity_W = {0, -9.81, 2};
  for (Joint& joint : simulation.mechanism.joints) {
    joint.load_friction.coefficient = 0.1;
    joint.load_friction.radius = 0.02;
    joint.load_friction.thrust_radius = 0.03;
    joint.load_friction.length = 0.05;
  }
  simulation.start_rates = {{{0, 0}, 3}};
  simulation.times = {0, 0.1};
  const SimulationResult stiff = Simulate(simulation);
  ASSERT_EQ(stiff.status, SimulationStatus::kFinished) << stiff.message;
  simulation.rule = ReactionRule::kMinimumNorm;
  simulation.norm_length = 0.01;
  const SimulationResult other = Simulate(simulation);
  EXPECT_GT((stiff.Q(1) - other.Q(1)).norm(), 1e-6);
  for (const SimulationResult* result : {&stiff, &other}) {
    EXPECT_EQ(CountCertain(*result), 0);
    EXPECT_EQ(result->warnings.size(), 1U);
  }
}

TEST(Simulate, EndsWhereAWatchedCoordinateIsReached) {
  Simulation simulation;
  simulation.mechanism = Block({0, 0, -1});
  simulation.watches = {{{0, 0}, 0.5, false}, {{0, 0}, 1, true}};
  simulation.times = {0, 0.1, 5};
  const SimulationResult result = Simulate(simulation, Tight(1e-12));
  EXPECT_EQ(result.status, SimulationStatus::kReached);
  ASSERT_EQ(result.events.size(), 2U);
  EXPECT_NEAR(result.events[0].time, std::sqrt(1 / kGravity), 1e-9);
  EXPECT_NEAR(result.times.back(), std::sqrt(2 / kGravity), 1e-9);
  EXPECT_NEAR(result.Q(result.size() - 1)[0], 1, 1e-9);
}

TEST(Simulate, KeepsWhatItHasWhenItIsStopped) {
  Simulation simulation;
  simulation.mechanism = Pendulum();
  simulation.times = Times(10, 100);
  SimulationOptions options;
  options.progress = [](double time) { return time < 3; };
  const SimulationResult result = Simulate(simulation, options);
  EXPECT_EQ(result.status, SimulationStatus::kInterrupted);
  EXPECT_GE(result.times.back(), 3);
  EXPECT_LT(result.size(), 60U);
  EXPECT_EQ(result.loads.poses.size(), result.size());
  EXPECT_EQ(result.q.size(), result.size());
}

}  // namespace
}  // namespace vmech
