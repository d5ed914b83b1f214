#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "simulated.h"
#include "support/windows.h"
#include "vmech/dynamics/simulation/modes.h"
#include "vmech/dynamics/simulation/run_audit.h"

namespace vmech {
namespace {

/// A body of 2 kg on a ball joint, carried by two links without mass: one that shifts along x, y
/// and turns about z, and one that shifts along z. The turn and the ball's undo each other.
Simulation CarriedBody() {
  Simulation simulation;
  Mechanism& mechanism = simulation.mechanism;
  mechanism.gravity_W = {0, 0, -9.81};
  mechanism.links = {{"frame", {}, {{"a", {}}}},
                     {"carrier", {}, {{"a", {}}, {"b", {}}}},
                     {"lift", {}, {{"a", {}}, {"b", {}}}},
                     {"body", {}, {{"a", {Matrix3d::Identity(), {0.1, -0.2, 0.3}}}}}};
  mechanism.links[3].mass_properties = {2, {0.3, 0.2, 0.1}, Vector3d(1, 2, 2.5).asDiagonal()};
  mechanism.joints = {MakeJoint("xy", JointType::kPlanar, {0, 0}, {1, 0}),
                      MakeJoint("z", JointType::kPrismatic, {1, 1}, {2, 0}),
                      MakeJoint("ball", JointType::kSpherical, {2, 1}, {3, 0})};
  mechanism.joints[0].passive.resize(3);
  simulation.start_rates = {{{2, 0}, 0.5}, {{2, 1}, 2}};
  simulation.times = {0, 0.5, 1, 1.5};
  return simulation;
}

constexpr int kTurn = 2;  // of "xy"

TEST(WithoutInertia, AForceThatNothingAnswersEndsTheRunAtItsStart) {
  Simulation simulation = CarriedBody();
  simulation.mechanism.joints[0].passive[kTurn] = {5, 0.5, 0, 0};
  for (const SimulationMethod method : {SimulationMethod::kAutomatic, SimulationMethod::kIdas}) {
    SimulationOptions options = Tight(1e-9);
    options.method = method;
    const SimulationResult result = Simulate(simulation, options);
    EXPECT_EQ(result.status, SimulationStatus::kFailed);
    EXPECT_EQ(result.times, std::vector<double>{0});
    for (const char* part : {"2.5 N or N m", "'xy.rz', 'ball.rz'", "mass", "lock"}) {
      EXPECT_NE(result.message.find(part), std::string::npos) << result.message;
    }
  }
}

TEST(WithoutInertia, AForceThatBeginsLaterEndsTheRunThere) {
  Simulation simulation = CarriedBody();
  JointMotor motor;
  motor.at = {0, kTurn};
  motor.force = {{0, 0.7, 0.8}, {0, 0, 3}, 0};
  simulation.motors = {motor};
  const SimulationResult result = Simulate(simulation, Tight(1e-9));
  EXPECT_EQ(result.status, SimulationStatus::kFailed);
  EXPECT_NE(result.message.find("'xy.rz'"), std::string::npos) << result.message;
  EXPECT_GE(result.times.back(), 0.7);
  EXPECT_LT(result.times.back(), 0.75);
}

TEST(WithoutInertia, WhatNothingMovesStandsStillAndIsTold) {
  const SimulationResult result = Simulate(CarriedBody(), Tight(1e-10));
  ASSERT_EQ(result.status, SimulationStatus::kFinished) << result.message;
  ASSERT_EQ(result.notes.size(), 1U);
  EXPECT_NE(result.notes[0].find("'xy.rz', 'ball.rz'"), std::string::npos) << result.notes[0];
  for (size_t i = 0; i < result.size(); ++i) EXPECT_EQ(result.Q(i)[kTurn], 0);
}

/// A mass on an arm whose hub has none: the arm is held by a spring against the hub, and the hub
/// by a drive, or by what rests in it.
Simulation SprungArm() {
  Simulation simulation;
  simulation.mechanism = Pendulum();
  Mechanism& mechanism = simulation.mechanism;
  mechanism.gravity_W.setZero();
  mechanism.links.push_back({"hub", {}, {{"pin", {}}, {"arm", {}}}});
  mechanism.joints[0] = MakeJoint("pin", JointType::kRevolute, {0, 0}, {2, 0});
  mechanism.joints.push_back(MakeJoint("arm", JointType::kRevolute, {2, 1}, {1, 0}));
  for (Joint& joint : mechanism.joints) joint.passive.resize(1);
  simulation.times = {0, 0.1, 0.2};
  return simulation;
}

TEST(WithoutInertia, WhatHoldsALinkWithoutMassBearsItsSprings) {
  Simulation simulation = SprungArm();
  simulation.mechanism.joints[0].passive[0] = {7, 0.5, 0, 0};
  simulation.mechanism.joints[1].passive[0] = {3, 0.2, 0, 0};
  simulation.drives = {{0, 0, MotionLaw::Uniform(0, 0.4)}};
  const SimulationResult result = Simulate(simulation, Tight(1e-12));
  ASSERT_EQ(result.status, SimulationStatus::kFinished) << result.message;
  for (size_t i = 0; i < result.size(); ++i) {
    const double pin = 0.4 * result.times[i], arm = PositionIn(result, i, "arm");
    // The hub: drive - 7 (pin - 0.5) + 3 (arm - 0.2) = 0.
    EXPECT_NEAR(result.loads.poses[i].drives[0].force, 7 * (pin - 0.5) - 3 * (arm - 0.2), 1e-9);
    EXPECT_NEAR(result.energies[i].error, 0, 1e-10);
  }
  // The arm swings at sqrt(3) rad/s about where its spring is slack, carried along by the hub.
  EXPECT_NEAR(
      PositionIn(result, 2, "arm") - 0.2,
      -0.2 * std::cos(std::sqrt(3) * 0.2) - 0.4 / std::sqrt(3) * std::sin(std::sqrt(3) * 0.2),
      1e-9);
}

// Springs in a row, with nothing between them; a damper there has a decay of its own.
TEST(WithoutInertia, SpringsGiveWayAtOnceInModesAndDampersAreToldOf) {
  Simulation simulation = SprungArm();
  simulation.mechanism.joints[0].passive[0].stiffness = 7;
  simulation.mechanism.joints[1].passive[0].stiffness = 3;
  const Modes modes = FindModes(simulation);
  ASSERT_EQ(modes.modes.size(), 1U);
  EXPECT_NEAR(2 * std::numbers::pi * modes.modes[0].frequency, std::sqrt(7. * 3 / (7 + 3)), 1e-9);
  EXPECT_TRUE(modes.warnings.empty());
  simulation.mechanism.joints[0].passive[0].viscous = 0.1;
  const Modes damped = FindModes(simulation);
  ASSERT_EQ(damped.warnings.size(), 1U);
  EXPECT_NE(damped.warnings[0].find("without inertia"), std::string::npos);
}

/// The same a hundred thousand lengths away: inertias are those of the body, wherever it is.
TEST(Simulate, MovesFarAwayAsItDoesNearBy) {
  Simulation simulation = CarriedBody();
  const SimulationResult here = Simulate(simulation, Tight(1e-10));
  const double far = 1e4;
  simulation.mechanism.joints[0].start = {far, -far, 0};
  simulation.mechanism.joints[0].start_given = true;
  const SimulationResult there = Simulate(simulation, Tight(1e-10));
  ASSERT_EQ(there.status, SimulationStatus::kFinished) << there.message;
  for (size_t i = 0; i < here.size(); ++i) {
    const VectorXd moved = there.Q(i) - here.Q(i);
    EXPECT_NEAR(moved[0], far, 1e-6);
    EXPECT_NEAR(moved[1], -far, 1e-6);
    EXPECT_LT(moved.tail(moved.size() - 2).cwiseAbs().maxCoeff(), 1e-6) << i;
    EXPECT_NEAR(there.energies[i].weight, here.energies[i].weight, 1e-6);
    EXPECT_NEAR(there.energies[i].error, 0, 1e-6);
  }
}

// Nothing but the energies depends on the steps where drives prescribe all motion.
TEST(Simulate, KnowsWhatDrivesSupplyThatPrescribeAllMotion) {
  Simulation simulation;
  simulation.mechanism = Pendulum();
  simulation.mechanism.joints[0].passive = {{0, 0, 2, 0}};
  simulation.drives = {{0, 0, MotionLaw::Uniform(0, 3)}};
  simulation.times = {0, 1, 2};
  const SimulationResult result = Simulate(simulation, Tight(1e-10));
  ASSERT_EQ(result.status, SimulationStatus::kFinished) << result.message;
  for (size_t i = 0; i < 3; ++i) {
    const double lost = 2 * 3 * 3 * result.times[i];
    EXPECT_NEAR(result.energies[i].supplied, 9.81 * std::sin(3 * result.times[i]) + lost, 1e-7);
    EXPECT_NEAR(result.energies[i].dissipated, lost, 1e-7);
  }
}

/// A window whose beam is a little too long, so that it cannot lie flat.
Simulation LongWindow(double excess) {
  Simulation simulation;
  simulation.mechanism = Windows(1, 0);
  simulation.mechanism.links[3].anchors[1].X_LA.p.x() += excess;
  simulation.start_rates = {{FreedomOf(simulation.mechanism, "a0"), 1}};
  for (int i = 0; i <= 15; ++i) simulation.times.push_back(0.1 * i);
  return simulation;
}

// Both posts come down together; where they would lie flat one of them goes on and the other stays
// lying, and so they do where the first has gone half round: there it stays, and the other rises.
TEST(NearlySingularPose, IsPassedOnTheLoopsAndWithItsEnergy) {
  for (const double excess : {1e-8, 3e-8, 1e-7, 1e-6, 1e-4}) {
    const Simulation simulation = LongWindow(excess);
    const SimulationResult result = Simulate(simulation, Tight(1e-10));
    ASSERT_EQ(result.status, SimulationStatus::kFinished) << excess << result.message;
    EXPECT_LT(EnergyError(result), 1e-5) << excess;
    EXPECT_NEAR(PositionIn(result, 10, "a1"), std::numbers::pi / 2, 2 * std::sqrt(excess));
    EXPECT_NEAR(PositionIn(result, 15, "a0"), 1.5 * std::numbers::pi, 2 * std::sqrt(excess));
    SimulationOptions by_idas = Tight(1e-9);
    by_idas.method = SimulationMethod::kIdas;
    const SimulationResult index_two = Simulate(simulation, by_idas);
    // So near to a singular pose index two has no answer, and says so.
    if (excess < 1e-7 && index_two.status == SimulationStatus::kFailed) continue;
    ASSERT_EQ(index_two.status, SimulationStatus::kFinished) << excess << index_two.message;
    EXPECT_NEAR(PositionIn(index_two, 15, "a1"), PositionIn(result, 15, "a1"), 1e-4) << excess;
  }
}

TEST(RunAudit, FindsEnergyThatTheToleranceDoesNotExplain) {
  const Simulation simulation = LongWindow(0);
  const PreparedSimulation prepared = PrepareSimulation(simulation);
  EquationsOfMotion equations(prepared);
  SimulationOptions options = Tight(1e-10);
  EnergySample sample;
  sample.kinetic = 10;
  for (const double sign : {-1, 1}) {
    RunAudit audit(options, &equations);
    sample.error = sign * 1e-5;
    EXPECT_EQ(audit.DescribeImbalance(sample, 1000), "");
    sample.error = sign * 1e-3;
    EXPECT_NE(audit.DescribeImbalance(sample, 1000).find("J of 10 J"), std::string::npos);
    EXPECT_EQ(audit.DescribeImbalance(sample, 1'000'000), "");
    sample.error = sign * 0.6;  // J, whatever the steps and the tolerance
    EXPECT_NE(audit.DescribeImbalance(sample, 1'000'000'000), "");
  }
}

TEST(StartRates, ThatContradictEachOtherAreRefused) {
  Simulation simulation = LongWindow(0);
  const FreedomId a0 = FreedomOf(simulation.mechanism, "a0");
  const FreedomId a1 = FreedomOf(simulation.mechanism, "a1");
  simulation.times = {0, 0.01};
  simulation.start_rates = {{a0, 2}, {a1, 2}};  // as the parallelogram has them
  EXPECT_TRUE(Simulate(simulation, Tight(1e-9)).moved_rates.empty());
  simulation.start_rates = {{a0, 2}, {a1, 2.0004}};  // rounded
  const SimulationResult rounded = Simulate(simulation, Tight(1e-9));
  EXPECT_EQ(rounded.moved_rates.size(), 2U);
  EXPECT_EQ(rounded.notes.size(), 1U);
  for (const std::vector<StartRate>& rates :
       {std::vector<StartRate>{{a0, 1}, {a1, 3}}, {{a0, 1}, {a0, 3}}}) {
    simulation.start_rates = rates;
    try {
      Simulate(simulation, Tight(1e-9));
      ADD_FAILURE();
    } catch (const std::invalid_argument& refused) {
      const std::string what = refused.what();
      for (const char* part : {"'a0' is given 1 rad/s", "is given 3 rad/s", "and has 2 rad/s"}) {
        EXPECT_NE(what.find(part), std::string::npos) << what;
      }
    }
  }
}

// A spring so stiff that steps are shorter than a millionth of a millionth of the run.
TEST(Simulate, DoesNotGoOnForEver) {
  Simulation simulation;
  simulation.mechanism = Pendulum();
  simulation.mechanism.joints[0].passive = {{1e24, 0.1, 0, 0}};
  simulation.times = {0, 1};
  SimulationOptions options = Tight(1e-10);
  options.loads = false;
  const SimulationResult result = Simulate(simulation, options);
  EXPECT_EQ(result.status, SimulationStatus::kFailed);
  EXPECT_NE(result.message.find("steps led on by"), std::string::npos) << result.message;
  EXPECT_NE(result.message.find("pin is at"), std::string::npos) << result.message;
  EXPECT_GT(result.times.back(), 0);
}

/// A four-bar of equal bars without weight, 5/3 kg m^2 about its crank, moved by a moment there.
Simulation MovedFourBar(const TimeTable& moment, const std::vector<double>& times) {
  Simulation simulation;
  simulation.mechanism = Windows(1, 1.2);
  simulation.mechanism.gravity_W.setZero();
  JointMotor motor;
  motor.at = {0, 0};
  motor.force = moment;
  simulation.motors = {motor};
  simulation.times = times;
  return simulation;
}

bool AnythingIsCertain(const SimulationResult& result) {
  for (const JointCertainty& verdicts : result.loads.certainty) {
    for (const Certainty verdict : verdicts) {
      if (verdict == Certainty::kCertain) return true;
    }
  }
  return false;
}

/// One contact is held, lets go at a time [s], and leaves loads certain.
void ExpectHeldUntil(double time, const Simulation& simulation, SimulationEvent::Kind held,
                     SimulationEvent::Kind let_go) {
  const SimulationResult result = Simulate(simulation);
  ASSERT_EQ(result.events.size(), 2U);
  EXPECT_EQ(result.events[0].kind, held);
  EXPECT_EQ(result.events[1].kind, let_go);
  EXPECT_NEAR(result.events[1].time, time, 1e-9);
  EXPECT_TRUE(AnythingIsCertain(result));
}

TEST(Certainty, OneContactThatSticksAndSlipsLeavesLoadsCertain) {
  Simulation simulation = MovedFourBar({{0, 1}, {0, 3}, 0}, {0, 1});
  simulation.mechanism.joints[0].passive[0].coulomb = 1.5;
  ExpectHeldUntil(0.5, simulation, SimulationEvent::Kind::kSticks, SimulationEvent::Kind::kSlips);
}

TEST(Certainty, ALimitThatClosesAndOpensLeavesLoadsCertain) {
  Simulation simulation = MovedFourBar({{0, 2}, {3, -3}, 0}, {0, 1.5});
  simulation.mechanism.joints[0].upper = {1.3};
  ExpectHeldUntil(1, simulation, SimulationEvent::Kind::kLimitCloses,
                  SimulationEvent::Kind::kLimitOpens);
}

TEST(Certainty, TwoContactsThatStickInALoopLeaveNothingCertain) {
  Simulation simulation = MovedFourBar({{0, 1}, {0, 1}, 0}, {0, 1});
  simulation.mechanism.joints[0].passive[0].coulomb = 1.5;
  simulation.mechanism.joints[1].passive[0].coulomb = 1.5;
  const SimulationResult result = Simulate(simulation);
  EXPECT_EQ(result.Q(1), result.Q(0));
  EXPECT_FALSE(AnythingIsCertain(result));
}

}  // namespace
}  // namespace vmech
