#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "simulated.h"
#include "support/windows.h"

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

/// A freedom x with constant inertia that falls on a stop under constant friction.
struct Fall {
  double inertia = 0, friction = 0, start = 0, stop = 0, restitution = 0;
  double (*energy)(double x) = nullptr;  ///< of its weight

  /// The speed at the stop of what comes from rest at `x`, or reaches x from the stop.
  double SpeedFrom(double x, double friction_power) const {
    const double work = energy(x) - energy(stop) - friction_power * std::abs(x - stop);
    return std::sqrt(2 * work / inertia);
  }
  double Apex(double speed) const {
    double far = start, near = stop;
    for (int i = 0; i < 100; ++i) {
      const double middle = 0.5 * (far + near);
      (SpeedFrom(middle, -friction) > speed ? far : near) = middle;
    }
    return far;
  }
};

void ExpectBouncesOfFall(const SimulationResult& result, const Fall& fall) {
  ASSERT_EQ(result.status, SimulationStatus::kFinished) << result.message;
  double speed = fall.SpeedFrom(fall.start, fall.friction);
  double last_time = -1;
  int bounces = 0;
  for (const SimulationEvent& event : result.events) {
    // Of limits that are run into together, those that rounding puts first.
    if (event.kind != Kind::kRebound || event.time == last_time) continue;
    last_time = event.time;
    if (speed > 0.01) EXPECT_NEAR(std::abs(event.rate), speed, 1e-8) << bounces;
    speed = fall.SpeedFrom(fall.Apex(fall.restitution * speed), fall.friction);
    ++bounces;
  }
  EXPECT_GT(bounces, 8);
  EXPECT_LT(bounces, 60);
  const size_t last = result.size() - 1;
  EXPECT_EQ(result.V(last).norm(), 0);
  EXPECT_NEAR(PositionIn(result, last, result.tree.mechanism.joints[0].name), fall.stop, 1e-9);
  EXPECT_NEAR(result.energies[last].dissipated, fall.energy(fall.start) - fall.energy(fall.stop),
              1e-7);
  for (size_t i = 1; i <= last; ++i) {
    EXPECT_GE(result.energies[i].dissipated, result.energies[i - 1].dissipated);
  }
  EXPECT_LT(EnergyError(result), 1e-8);
}

TEST(Contacts, APendulumWithFrictionBouncesToRestOnItsStop) {
  Simulation simulation = BouncingPendulum(0.6);
  simulation.mechanism.joints[0].passive[0].coulomb = 1.5;
  const SimulationResult result = Simulate(simulation, Tight(1e-13));
  ExpectBouncesOfFall(result,
                      {1, 1.5, 0, -1, 0.6, [](double x) { return kGravity * std::sin(x); }});
  // Stop and friction carry the weight between them.
  EXPECT_NEAR(result.loads.poses[60].joints[0].moment.z(), kGravity * std::cos(1), 1e-9);
}

/// Two equal cranks, each with its stop: both are run into at once, and either would do.
TEST(Contacts, AParallelogramWithFrictionBouncesToRestOnTwoStops) {
  Simulation simulation;
  simulation.mechanism = Windows(1, 0.3);
  for (Joint& joint : simulation.mechanism.joints) joint.passive[0].coulomb = 0.4;
  for (const int crank : {0, 1}) {
    simulation.mechanism.joints[static_cast<size_t>(crank)].upper = {0.9};
    simulation.rebounds.push_back({{crank, 0}, 0.5});
  }
  simulation.times = Times(3, 30);
  const SimulationResult result = Simulate(simulation, Tight(1e-13));
  ExpectBouncesOfFall(result, {5. / 3, 4 * 0.4, 0.3, 0.9, 0.5,
                               [](double x) { return 2 * kGravity * std::cos(x); }});
  EXPECT_LT(result.events.size(), 150U);
  EXPECT_LT(result.Vdot(30).norm(), 1e-9);
}

SimulationResult DownToStop(double angle, double coefficient) {
  Simulation simulation;
  simulation.mechanism = Block({std::cos(angle), 0, -std::sin(angle)});
  simulation.mechanism.joints[0].load_friction.coefficient = coefficient;
  simulation.mechanism.joints[0].upper = {0.5};
  simulation.start_rates = {{{0, 0}, 3}};
  simulation.rebounds = {{{0, 0}, 0.7}};
  simulation.times = Times(4, 40);
  return Simulate(simulation, Tight(1e-13));
}

TEST(Contacts, ABlockThatHitsAStopSticksWhereItComesBackToOrRestsOnTheStop) {
  for (const double angle : {std::atan(0.4) - 0.1, std::atan(0.4) + 0.1}) {
    const SimulationResult result = DownToStop(angle, 0.4);
    const double down = kGravity * (std::sin(angle) - 0.4 * std::cos(angle));
    const double up = kGravity * (std::sin(angle) + 0.4 * std::cos(angle));
    double speed = std::sqrt(9 + 2 * down * 0.5), time = (speed - 3) / down, high = 0;
    std::vector<SimulationEvent> rebounds;
    for (const SimulationEvent& event : result.events) {
      if (event.kind == Kind::kRebound) rebounds.push_back(event);
    }
    for (const SimulationEvent& event : rebounds) {
      if (speed < 0.01) break;
      EXPECT_NEAR(event.rate, speed, 1e-8);
      EXPECT_NEAR(event.time, time, 1e-8);
      const double back = 0.7 * speed;
      high = back * back / (2 * up);
      speed = std::sqrt(std::max(0.0, 2 * down * high));
      time += back / up + (down > 0 ? speed / down : 0);
    }
    const bool sticks = down < 0;
    EXPECT_EQ(rebounds.size() == 1, sticks);
    EXPECT_LT(rebounds.size(), 60U);
    EXPECT_NEAR(result.Q(40)[0], sticks ? 0.5 - high : 0.5, 1e-9);
    EXPECT_EQ(result.V(40)[0], 0);
    // Along the slope the weight is held, by friction, or by friction and the stop.
    EXPECT_NEAR(result.loads.poses[40].joints[0].force.z(), -2 * kGravity * std::sin(angle), 1e-8);
    EXPECT_LT(EnergyError(result), 1e-8);
  }
}

/// Friction in the rocker of a crank-rocker, which turns back while all else moves on.
TEST(Contacts, FrictionTurnsRoundWhereARockerDoes) {
  Simulation simulation;
  simulation.mechanism = Example("four-bar");
  simulation.mechanism.joints[3].passive[0].coulomb = 0.4;
  simulation.start_rates = {{{0, 0}, 12}};
  simulation.times = Times(1, 2000);
  const SimulationResult result = Simulate(simulation, Tight(1e-11));
  EXPECT_LT(result.statistics.restarts, 20);
  EXPECT_LT(EnergyError(result), 1e-8);
  double way = 0;
  int turns = 0;
  for (size_t i = 1; i < result.size(); ++i) {
    way +=
        std::abs(PositionIn(result, i, "rocker_pivot") - PositionIn(result, i - 1, "rocker_pivot"));
    const LoadArrays& loads = result.loads.poses.arrays();
    if (loads.Joint(i, 3).rate[0] * loads.Joint(i - 1, 3).rate[0] < 0) ++turns;
  }
  EXPECT_GT(turns, 2);
  EXPECT_NEAR(result.energies.back().dissipated, 0.4 * way, 1e-5);
  // A universal joint there has another freedom, which the loop never moves, and friction holds
  // for ever what nothing moves.
  Joint& pin = simulation.mechanism.joints[2];
  const Matrix3d x_on_z = AxesFromZX(Vector3d::UnitY(), Vector3d::UnitZ());
  for (const AnchorId& id : {pin.first, pin.second}) {
    Posed& X_LA = simulation.mechanism.links[id.link].anchors[id.anchor].X_LA;
    X_LA.R = X_LA.R * x_on_z;
  }
  const double start = pin.start[0];
  pin = MakeJoint(pin.name, JointType::kUniversal, pin.first, pin.second);
  pin.start = {start, 0};
  pin.passive[0].coulomb = pin.passive[1].coulomb = 0.1;
  const SimulationResult universal = Simulate(simulation, Tight(1e-11));
  ASSERT_EQ(universal.status, SimulationStatus::kFinished) << universal.message;
  EXPECT_LT(EnergyError(universal), 1e-8);
  EXPECT_GT(universal.energies.back().dissipated, result.energies.back().dissipated + 0.1);
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

TEST(Contacts, ATubeWithFrictionInItsTurnSticksThereAndGoesOnShifting) {
  Simulation simulation;
  Mechanism& m = simulation.mechanism;
  m = Block({0, 0, -1});  // 0.01 kg m^2
  m.joints = {MakeJoint("tube", JointType::kCylindrical, {0, 0}, {1, 0})};
  m.joints[0].passive[1].coulomb = 0.02;
  simulation.start_rates = {{{0, 1}, 3}};
  simulation.times = {0, 2};
  const SimulationResult result = Simulate(simulation, Tight(1e-12));
  ASSERT_EQ(result.events.size(), 1U);
  EXPECT_EQ(result.events[0].kind, Kind::kSticks);
  EXPECT_NEAR(result.events[0].time, 1.5, 1e-9);
  const JointSample tube = result.loads.poses.arrays().Joint(1, 0);
  EXPECT_NEAR(tube.position[0], 2 * kGravity, 1e-9);
  EXPECT_NEAR(tube.position[1], 3 * 1.5 / 2, 1e-9);
  EXPECT_EQ(tube.rate[1], 0);
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

/// A pendulum that is let go at 0 turns back at -pi, wherever that is within a step.
TEST(Simulate, SeesWhatIsBarelyTouchedWithinAStep) {
  for (const double depth : {1e-2, 1e-4, 1e-6}) {
    const double touched = -std::numbers::pi + depth;
    Simulation simulation;
    simulation.mechanism = Pendulum();
    simulation.watches = {{{0, 0}, touched, false}};
    simulation.times = Times(2, 4);
    EXPECT_EQ(Simulate(simulation, Tight(1e-10)).events.size(), 2U) << depth;
    simulation.watches.clear();
    simulation.mechanism.joints[0].lower = {touched};
    simulation.rebounds = {{{0, 0}, 0.5}};
    simulation.times = Times(2, 200);
    const SimulationResult result = Simulate(simulation, Tight(1e-10));
    EXPECT_GE(result.events.size(), 1U) << depth;
    for (size_t i = 0; i < result.size(); ++i) EXPECT_GT(result.Q(i)[0], touched - 1e-9);
  }
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
