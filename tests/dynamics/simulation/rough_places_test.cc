#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "simulated.h"
#include "vmech/kinematics/tree/kinematic_tree.h"

namespace vmech {
namespace {

using Kind = SimulationEvent::Kind;

std::vector<double> Times(double end, int steps) {
  std::vector<double> times;
  for (int i = 0; i <= steps; ++i) times.push_back(end * i / steps);
  return times;
}

Simulation FallOf(const std::string& example, std::vector<double> times) {
  Simulation simulation;
  simulation.mechanism = Example(example);
  simulation.times = std::move(times);
  return simulation;
}

double CoordinateIn(const SimulationResult& result, size_t pose, const std::string& joint) {
  return result.Q(pose)[CoordinateIndex(result.tree, FindJoint(result.tree.mechanism, joint), 0)];
}

SimulationOptions WithoutLoads(double tolerance) {
  SimulationOptions options = Tight(tolerance);
  options.loads = false;
  return options;
}

// Crank and rod are equally long: at 90 degrees the slider is at the main bearing, where it could
// stay for good while both turn as one. A motion goes on as it came, whatever the crank's velocity
// counts for in the loop there: nothing.
TEST(SingularPose, ASliderGoesThroughTheBranchWhereItCouldStay) {
  const SimulationResult result =
      Simulate(FallOf("marghitu-slider-crank", Times(10, 1000)), WithoutLoads(1e-12));
  ASSERT_EQ(result.status, SimulationStatus::kFinished) << result.message;
  double least = 0;
  for (size_t i = 0; i < result.size(); ++i) {
    const double crank = CoordinateIn(result, i, "main");
    least = std::min(least, crank);
    ASSERT_NEAR(CoordinateIn(result, i, "guide"), 2 * std::cos(crank), 1e-11) << result.times[i];
  }
  EXPECT_LT(least, -200 * std::numbers::pi / 180);
  EXPECT_LT(EnergyError(result), 1e-8);
}

// The way up is that down in a mirror: at rest after twice the time to the lowest pose, which is
// the singular one, and is watched for.
TEST(SingularPose, WhatIsWatchedForThereIsFoundInTime) {
  Simulation simulation = FallOf("marghitu-slider-crank", {0, 2});
  const FreedomId main{FindJoint(simulation.mechanism, "main"), 0};
  simulation.watches = {{main, -std::numbers::pi / 2, false}};
  const SimulationResult down = Simulate(simulation, WithoutLoads(1e-12));
  ASSERT_EQ(down.events.size(), 1U);
  simulation.times = {0, 2 * down.events[0].time};
  const SimulationResult up = Simulate(simulation, WithoutLoads(1e-12));
  EXPECT_NEAR(CoordinateIn(up, 1, "main"), -1.25 * std::numbers::pi, 1e-8);
  EXPECT_LT(up.V(1).cwiseAbs().maxCoeff(), 1e-6);
  SimulationOptions by_idas = WithoutLoads(1e-9);
  by_idas.method = SimulationMethod::kIdas;
  const SimulationResult index_two = Simulate(simulation, by_idas);
  ASSERT_EQ(index_two.status, SimulationStatus::kFinished) << index_two.message;
  EXPECT_NEAR(CoordinateIn(index_two, 1, "main"), -1.25 * std::numbers::pi, 1e-5);
  // A run may end there.
  simulation.times = {0, down.events[0].time};
  const SimulationResult there = Simulate(simulation, WithoutLoads(1e-12));
  ASSERT_EQ(there.status, SimulationStatus::kFinished) << there.message;
  EXPECT_NEAR(CoordinateIn(there, 1, "main"), -std::numbers::pi / 2, 1e-9);
  EXPECT_EQ(there.times.back(), down.events[0].time);
}

// Where its three couples of rods lie so that the platform could turn, a delta robot that falls
// freely goes on without.
TEST(SingularPose, ADeltaRobotFallsThroughPosesWhereItsPlatformCouldTurn) {
  const SimulationResult result =
      Simulate(FallOf("delta-robot", Times(3, 60)), WithoutLoads(1e-10));
  ASSERT_EQ(result.status, SimulationStatus::kFinished) << result.message;
  const auto angle = [&](size_t pose, const std::string& joint, int freedom) {
    const int j = FindJoint(result.tree.mechanism, joint);
    return result.Q(pose)[CoordinateIndex(result.tree, j, freedom)];
  };
  for (size_t i = 0; i < result.size(); ++i) {
    EXPECT_NEAR(angle(i, "motor1", 0) + angle(i, "elbow1", 0), angle(i, "wrist1", 1), 1e-8) << i;
    EXPECT_NEAR(angle(i, "elbow1", 1), -angle(i, "wrist1", 0), 1e-8) << i;
  }
  EXPECT_LT(EnergyError(result), 1e-7);
}

// A thousandth of the accuracy for a fraction of the steps, and not for more of them.
TEST(Simulate, TakesFewerStepsWhereLessIsAsked) {
  const Simulation simulation = FallOf("four-bar", Times(10, 10));
  long before = std::numeric_limits<long>::max();
  for (const double tolerance : {1e-12, 1e-10, 1e-9, 1e-8, 1e-6}) {
    const SimulationResult result = Simulate(simulation, WithoutLoads(tolerance));
    EXPECT_LT(result.statistics.steps, before) << tolerance;
    EXPECT_LT(EnergyError(result), 1e3 * tolerance) << tolerance;
    EXPECT_LT(result.statistics.largest_closure, 1e-12);
    before = result.statistics.steps;
  }
}

// In a ball that turns hard about x and z, and freely about y, alike about all axes: the hard turn
// ends after w I / f, and the free one goes on.
TEST(Contacts, ABallRestsAboutItsHardAxesWhileItTurnsAboutTheFreeOne) {
  Simulation simulation;
  Mechanism& mechanism = simulation.mechanism;
  mechanism.gravity_W.setZero();
  mechanism.links.resize(2);
  const MassProperties ball{1, Vector3d::Zero(), 0.1 * Matrix3d::Identity()};
  mechanism.links[0] = {"frame", {}, {{"centre", {}}}};
  mechanism.links[1] = {"ball", ball, {{"centre", {}}}};
  mechanism.joints = {MakeJoint("socket", JointType::kSpherical, {0, 0}, {1, 0})};
  mechanism.joints[0].passive.resize(3);
  mechanism.joints[0].passive[0].coulomb = mechanism.joints[0].passive[2].coulomb = 0.5;
  simulation.start_rates = {{{0, 0}, 3}, {{0, 1}, -2}, {{0, 2}, 4}};
  simulation.times = Times(2, 4);
  const SimulationResult result = Simulate(simulation, WithoutLoads(1e-12));
  ASSERT_EQ(result.status, SimulationStatus::kFinished) << result.message;
  ASSERT_EQ(result.events.size(), 1U);
  EXPECT_EQ(result.events[0].kind, Kind::kSticks);
  EXPECT_NEAR(result.events[0].time, 5 * 0.1 / 0.5, 1e-8);
  EXPECT_NEAR(result.V(1)[0], 1.5, 1e-9);
  EXPECT_NEAR(result.V(1)[2], 2, 1e-9);
  EXPECT_NEAR((result.V(4) - Vector3d(0, -2, 0)).norm(), 0, 1e-9);
}

}  // namespace
}  // namespace vmech
