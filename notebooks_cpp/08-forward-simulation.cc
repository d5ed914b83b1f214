//%% [markdown]
// # Forward simulation
//
// So far the motion was given, and the forces were asked for. Now forces are given, and the motion
// is asked for: the mechanism falls, swings, rubs and comes to rest by its own dynamics,
//
// $$
// M(q) \dot{v} + h(q, v) = f - C^T \mu, \quad C v = 0
// $$
//
// This chapter compares `Simulate` with what is known better: an elliptic integral, a published
// benchmark, the energy, a law of friction, and the order of the real-time loop's step.

//%%
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "notebook.h"
#include "vmech/dynamics/in_hand/coupled_dynamics.h"
#include "vmech/dynamics/simulation/simulate.h"
#include "vmech/kinematics/loops/assembled_mechanism.h"
#include "vmech/kinematics/tree/grasp_frame.h"
#include "vmech/mechanisms/files/reader.h"

using namespace vmech;

namespace {

constexpr double kGravity = 9.81;
constexpr double kDown = -0.5 * std::numbers::pi;

Mechanism Example(const std::string& name) {
  return ReadMechanism("mechanisms/examples/" + name + ".yaml");
}

/// A point mass on a bar of 1 m, about an axis z; zero is to the right, gravity down.
Mechanism Pendulum(double mass) {
  Mechanism pendulum;
  pendulum.gravity_W = {0, -kGravity, 0};
  pendulum.links.resize(2);
  pendulum.links[0].name = "frame";
  pendulum.links[0].anchors = {{"pin", {}}};
  pendulum.links[1].name = "bob";
  pendulum.links[1].anchors = {{"pin", {}}};
  pendulum.links[1].mass_properties = {mass, {1, 0, 0}, Matrix3d::Zero()};
  pendulum.joints = {MakeJoint("pin", JointType::kRevolute, {0, 0}, {1, 0})};
  return pendulum;
}

std::vector<double> EvenTimes(double end, int steps) {
  std::vector<double> times;
  for (int i = 0; i <= steps; ++i) times.push_back(end * i / steps);
  return times;
}

/// The coordinate of a joint, row by row.
std::vector<double> PositionsOf(const SimulationResult& result, const std::string& joint) {
  const auto index = static_cast<size_t>(FindJoint(result.tree.mechanism, joint));
  std::vector<double> positions;
  for (size_t i = 0; i < result.size(); ++i) {
    positions.push_back(result.loads.poses.arrays().Joint(i, index).position[0]);
  }
  return positions;
}

}  // namespace

//%% tags=["remove-cell"]
int main(int argc, char** argv) {
  Notebook notebook(argc, argv);

  //%% [markdown]
  // ## A pendulum, and its elliptic integral
  //
  // A pendulum of length $l$ that swings by $\theta$ to either side takes
  //
  // $$
  // T = 4 \sqrt{\frac{l}{g}} K\left(\sin\frac{\theta}{2}\right)
  // $$
  //
  // with the complete elliptic integral of the first kind, $K$. A `CoordinateWatch` tells when it
  // is at its lowest: first after a quarter of the period, then after half a period each time.

  //%%
  plot::LinePlot periods;
  periods.title = "The period grows with the swing";
  periods.x = {"swing to either side", "deg"};
  periods.y = {"period", "s"};
  periods.series = {{"elliptic integral", {}, {}, plot::LineStyle::kDashed},
                    {"simulated", {}, {}, plot::LineStyle::kNone, plot::Marker::kCircle}};
  double worst_period = 0;
  for (const int degrees : {1, 30, 60, 90, 120, 150, 165, 175}) {
    const double swing = degrees * std::numbers::pi / 180;
    const double expected = 4 / std::sqrt(kGravity) * std::comp_ellint_1(std::sin(swing / 2));
    Simulation simulation;
    simulation.mechanism = Pendulum(1);
    simulation.mechanism.joints[0].start = {kDown + swing};
    simulation.watches = {{{0, 0}, kDown, false}};
    simulation.times = {0, 1.5 * expected};
    SimulationOptions options;
    options.relative_tolerance = options.absolute_tolerance = 1e-12;
    const SimulationResult result = Simulate(simulation, options);
    const double period = result.events.at(2).time - result.events.at(0).time;
    for (plot::Series& series : periods.series) series.x.push_back(degrees);
    periods.series[0].y.push_back(expected);
    periods.series[1].y.push_back(period);
    worst_period = std::max(worst_period, std::abs(period / expected - 1));
  }
  notebook.Show(periods);
  notebook.Print(fmt::format("largest relative error of a period: {:.1e}", worst_period));
  notebook.CheckNear("period over elliptic integral", 1 + worst_period, 1, 1e-9);

  //%% [markdown]
  // ## Andrews' squeezer
  //
  // Seven bodies in three loops, driven by a constant torque of 0.033 N m: within 30 ms the input
  // makes two and a half turns while a spring throws the rest about. It is the hard problem of
  // every collection of test problems; the values at the end are those of the Test Set for IVP
  // Solvers (CWI Amsterdam and Bari, problem "andrews"), published to 1.4e-9 rad.

  //%%
  Simulation squeezer;
  squeezer.mechanism = Example("andrews-squeezer");
  JointMotor torque;
  torque.at = {FindJoint(squeezer.mechanism, "main"), 0};
  torque.force = {{0}, {0.033}, 0};
  squeezer.motors = {torque};
  squeezer.times = EvenTimes(0.03, 300);
  const SimulationResult squeezed = Simulate(squeezer);
  const std::pair<const char*, double> published[] = {
      {"main", 15.810771195155032}, {"k2", -15.756371058413496}, {"k3", 0.040822240119658605},
      {"k4", -0.5347301163420572},  {"k5", 0.5244099658799546},  {"k6", 0.5347301163420572},
      {"k7", 1.0480807410419382}};
  html::Table angles;
  angles.columns = {
      {"Joint"}, {"Simulated [rad]", true}, {"Published [rad]", true}, {"Difference", true}};
  plot::LinePlot squeezing;
  squeezing.title = "Andrews' squeezer: the joints that do not turn round";
  squeezing.x = {"time", "ms"};
  squeezing.y = {"angle", "rad"};
  double worst_angle = 0;
  for (const auto& [joint, expected] : published) {
    const std::vector<double> positions = PositionsOf(squeezed, joint);
    const double difference = positions.back() - expected;
    worst_angle = std::max(worst_angle, std::abs(difference));
    angles.rows.push_back({joint, fmt::format("{:.12f}", positions.back()),
                           fmt::format("{:.12f}", expected), fmt::format("{:.1e}", difference)});
    if (std::abs(expected) > 10) continue;
    plot::Series series{joint, {}, positions};
    for (const double time : squeezed.times) series.x.push_back(1e3 * time);
    squeezing.series.push_back(series);
  }
  notebook.Show(squeezing);
  notebook.Show(angles);
  notebook.Print(squeezed.BriefReport());
  notebook.CheckNear("largest difference from what is published [rad]", worst_angle, 0, 1e-8);

  //%% [markdown]
  // ## Loops that drift, and how often to close them
  //
  // The integrator knows accelerations; that loops are closed is only a consequence, and its errors
  // open them. `Simulate` closes them again where they have drifted by more than
  // `drift_tolerance`, by the nearest step in the metric of the mass, and the integrator begins
  // anew from there, with short steps of lowest order. To ask for loops that are closed far better
  // than the integrator's own tolerance therefore costs what it should save. Bricard's linkage
  // falls for ten seconds with a tolerance as loose as 1e-5: closed never, closed beyond 1e-5, and
  // closed beyond 1e-7 (rates are projected in each). Unless told otherwise `Simulate` allows ten
  // times the tolerance.

  //%%
  Simulation bricard;
  bricard.mechanism = Example("bricard");
  bricard.times = EvenTimes(10, 200);
  SimulationOptions loose;
  loose.relative_tolerance = loose.absolute_tolerance = 1e-5;
  loose.loads = false;
  plot::LinePlot drift;
  drift.title = "Bricard's linkage: energy that cannot be accounted for";
  drift.x = {"time", "s"};
  drift.y = {"error", "J", plot::ScaleType::kLog};
  html::Table kept;
  kept.columns = {
      {"Closed"}, {"Drift", true}, {"Times", true}, {"Steps", true}, {"Energy [J]", true}};
  std::vector<SimulationStatistics> runs;
  std::vector<double> lost;  // the largest error of energy [J]
  for (const auto& [name, tolerance, line] :
       {std::tuple("never", 1e-3, plot::LineStyle::kDashed),
        std::tuple("beyond 1e-5", 1e-5, plot::LineStyle::kSolid),
        std::tuple("beyond 1e-7", 1e-7, plot::LineStyle::kDotted)}) {
    constexpr double kLeast = 1e-12;  // the axis is logarithmic
    loose.drift_tolerance = tolerance;
    const SimulationResult result = Simulate(bricard, loose);
    plot::Series series{name, {}, {}, line};
    lost.push_back(0);
    for (size_t i = 1; i < result.size(); ++i) {
      const double error = std::abs(result.energies[i].error);
      series.x.push_back(result.times[i]);
      series.y.push_back(std::max(kLeast, error));
      lost.back() = std::max(lost.back(), error);
    }
    drift.series.push_back(series);
    const SimulationStatistics& run = result.statistics;
    kept.rows.push_back({name, fmt::format("{:.1e}", run.largest_drift),
                         fmt::format("{}", run.projections), fmt::format("{}", run.steps),
                         fmt::format("{:.1e}", lost.back())});
    runs.push_back(run);
  }
  notebook.Show(drift);
  notebook.Show(kept);
  notebook.Check("never means never", runs[0].projections == 0);
  notebook.Check("closed beyond the tolerance, loops stay closed better",
                 2 * runs[1].largest_drift < runs[0].largest_drift);
  notebook.Check("closed far beyond it, steps are ten times as many, and worse",
                 runs[2].steps > 10 * runs[1].steps && lost[2] > 10 * lost[1]);
  notebook.Check("results are closed in every case",
                 std::max({runs[0].largest_closure, runs[1].largest_closure,
                           runs[2].largest_closure}) < 1e-12);

  //%% [markdown]
  // ## A door with friction
  //
  // A door of 3 kg m^2, pushed to 2 rad/s, whose hinges rub with 1.5 N m. Friction that slides is a
  // constant torque: it slows down by 0.5 rad/s each second, stops after 4 s and 4 rad, and stays.
  // A force that only changes its sign would tremble there; `Simulate` finds the time as the root
  // of the rate and holds the door from then on with whatever it takes, here nothing.

  //%%
  Simulation door;
  door.mechanism = Pendulum(3);
  door.mechanism.gravity_W.setZero();
  door.mechanism.joints[0].start = {0};
  door.mechanism.joints[0].passive[0].coulomb = 1.5;
  door.start_rates = {{{0, 0}, 2}};
  door.times = EvenTimes(6, 120);
  const SimulationResult shut = Simulate(door);
  plot::LinePlot closing;
  closing.title = "A door comes to rest";
  closing.x = {"time", "s"};
  closing.y = {"angle [rad], torque [N m]", ""};
  closing.series = {{"angle", shut.times, PositionsOf(shut, "pin")},
                    {"torque of the hinges", shut.times, {}, plot::LineStyle::kDashed}};
  for (size_t i = 0; i < shut.size(); ++i) {
    closing.series[1].y.push_back(shut.loads.poses.arrays().Wrench(i, 0).moment.z());
  }
  notebook.Show(closing);
  notebook.CheckNear("it stops at [s]", shut.events.at(0).time, 4, 1e-8);
  notebook.CheckNear("where it stays [rad]", shut.Q(120)[0], 4, 1e-8);
  notebook.Check("it does not move afterwards", shut.Q(100)[0] == shut.Q(120)[0]);
  notebook.CheckNear("friction has taken its energy [J]", shut.energies.back().dissipated, 6, 1e-8);

  //%% [markdown]
  // ## The real-time loop's step
  //
  // `vmech haptic` moves the same mechanism in a hand by one implicit step each period
  // (`CoupledDynamics`, chapter 6). It cannot choose its step; but as the period shrinks it must
  // come to the same motion. A four-bar on the spring of a hand that stands still beside it, after
  // 0.1 s:

  //%%
  Simulation held;
  held.mechanism = Example("four-bar");
  GraspSpring spring;
  spring.grasp = 0;
  spring.coupling.stiffness << 40, 40, 40, 0.5, 0.5, 0.5;
  spring.coupling.damping << 4, 4, 4, 0.02, 0.02, 0.02;
  const KinematicTree tree = BuildKinematicTree(RequireAssembled(held.mechanism).mechanism);
  const GraspFrame grasp = GraspFrameOf(tree, 0);
  const VectorXd q = StartCoordinates(tree);
  Posed X_WH = CoupledDynamics(tree, grasp, spring.coupling, 1e-3, q).X_WG();
  X_WH.p += Vector3d(0.03, 0.02, 0);
  spring.hand = [&](double) { return HandSample{X_WH, Vector6d::Zero(), Vector6d::Zero()}; };
  held.hand = spring;
  constexpr double kEnd = 0.1;
  held.times = {0, kEnd};
  const double exact = PositionsOf(Simulate(held), tree.mechanism.joints[0].name).back();
  plot::LinePlot order;
  order.title = "Error of the fixed step";
  order.x = {"step", "ms", plot::ScaleType::kLog};
  order.y = {"error of the crank", "rad", plot::ScaleType::kLog};
  order.series = {{"CoupledDynamics", {}, {}, plot::LineStyle::kSolid, plot::Marker::kCircle}};
  double last_order = 0;
  for (const double step : {2e-3, 1e-3, 5e-4, 2.5e-4, 1.25e-4}) {
    CoupledDynamics loop(tree, grasp, spring.coupling, step, q);
    const long steps = std::lround(kEnd / step);
    for (long i = 0; i < steps; ++i) static_cast<void>(loop.Step(X_WH, Vector6d::Zero()));
    const double error = std::abs(loop.q()[CoordinateIndex(tree, 0, 0)] - exact);
    plot::Series& series = order.series[0];
    if (!series.y.empty()) last_order = std::log2(series.y.back() / error);
    series.x.push_back(1e3 * step);
    series.y.push_back(error);
  }
  notebook.Show(order);
  notebook.CheckNear("order of the step", last_order, 1, 0.05);

  //%% [markdown]
  // An implicit Euler step is of first order: half the period, half the error. It pays for its
  // simplicity with a little damping, which is what keeps a hand safe.

  //%% tags=["remove-cell"]
  return notebook.ExitCode();
}
