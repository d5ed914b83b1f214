#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "support/examples.h"
#include "support/windows.h"
#include "vmech/dynamics/simulation/simulate.h"

namespace vmech {
namespace {

void Print(const char* name, const SimulationResult& result) {
  const SimulationStatistics& s = result.statistics;
  double worst = 0, scale = 0;
  for (const EnergySample& e : result.energies) {
    worst = std::max(worst, std::abs(e.error));
    scale = std::max({scale, std::abs(e.kinetic), std::abs(e.weight)});
  }
  std::printf(
      "%s: %s  proj %ld restarts %ld part %ld sing %ld drift %.1e closure %.1e energy %.2e "
      "etf %ld nlf %ld  %.2f ms\n",
      name, result.BriefReport().c_str(), s.projections, s.restarts, s.partitions, s.singular_poses,
      s.largest_drift, s.largest_closure, worst / scale, s.error_test_failures,
      s.nonlinear_failures, 1e3 * s.seconds);
}

TEST(Simulate, NWindows) {
  const double expected[][3] = {{1, 0.478385057760970559, 0.878150178791209301},
                                {2, 0.328458111540815379, 0.944518538178600962},
                                {40, 0.18051222668672839, 0.983572740582311575}};
  for (const auto& [n, x, y] : expected) {
    Simulation simulation;
    simulation.mechanism = Windows(static_cast<int>(n), 0);
    simulation.start_rates = {{{0, 0}, -1}};
    simulation.times = {0, 10};
    SimulationOptions options;
    options.loads = n < 3;
    const SimulationResult result = Simulate(simulation, options);
    Print("windows", result);
    const double lean = result.q[result.tree.nq + CoordinateIndex(result.tree, 0, 0)];
    std::printf("   error %.2e %.2e\n", -std::sin(lean) - x, std::cos(lean) - y);
  }
}

TEST(Simulate, Andrews) {
  Simulation simulation;
  simulation.mechanism = Example("andrews-squeezer");
  const int main = FindJoint(simulation.mechanism, "main");
  JointMotor motor;
  motor.at = {main, 0};
  motor.force = {{0}, {0.033}, 0};
  simulation.motors = {motor};
  simulation.times = {0, 0.03};
  const char* names[] = {"main", "k2", "k3", "k4", "k5", "k6", "k7"};
  const double q[] = {15.810771195155032,  -15.756371058413496, 0.040822240119658605,
                      -0.5347301163420572, 0.5244099658799546,  0.5347301163420572,
                      1.0480807410419382};
  for (double tol : {1e-8, 1e-9, 1e-10, 1e-11}) {
    SimulationOptions options;
    options.relative_tolerance = options.absolute_tolerance = tol;
    options.loads = false;
    const SimulationResult result = Simulate(simulation, options);
    Print("andrews", result);
    double worst = 0;
    for (int i = 0; i < 7; ++i) {
      const int at = CoordinateIndex(result.tree, FindJoint(simulation.mechanism, names[i]), 0);
      if (at >= 0) worst = std::max(worst, std::abs(result.q[result.tree.nq + at] - q[i]));
    }
    std::printf("  tol %.0e error %.2e\n", tol, worst);
  }
}

TEST(Simulate, Bricard) {
  Simulation simulation;
  simulation.mechanism = Example("bricard");
  simulation.times = {0, 10};
  SimulationOptions options;
  const SimulationResult result = Simulate(simulation, options);
  Print("bricard", result);
  for (const LinkMotion& m : result.loads.poses.back().links) {
    std::printf("  %.10f %.10f %.10f\n", m.X_WL.p.x(), m.X_WL.p.y(), m.X_WL.p.z());
  }
}

TEST(Simulate, Governor) {
  Simulation simulation;
  simulation.mechanism = Example("flyball-governor");
  const auto joint = [&](const char* name) { return FindJoint(simulation.mechanism, name); };
  simulation.start_rates = {{{joint("spin"), 0}, 2 * std::numbers::pi}};
  simulation.times = {0, 0.05, 0.1, 0.5, 1, 10};
  for (SimulationMethod method : {SimulationMethod::kAutomatic, SimulationMethod::kBdf}) {
    SimulationOptions options;
    options.method = method;
    const SimulationResult result = Simulate(simulation, options);
    Print("governor", result);
    for (size_t i = 0; i < result.size(); ++i) {
      const auto& p = result.loads.poses.arrays();
      std::printf("  %.3f  %.12f %.12f\n", result.times[i], p.Joint(i, joint("spin")).position[0],
                  p.Joint(i, joint("slide")).position[0]);
    }
  }
}

TEST(Simulate, SliderCrank) {
  Simulation simulation;
  simulation.mechanism = Example("sundials-slider-crank");
  const auto joint = [&](const char* name) { return FindJoint(simulation.mechanism, name); };
  ExternalLoad load;
  load.link = FindLink(simulation.mechanism, "rod");
  load.p_L = {1, 0, 0};
  load.wrenches = {{{1, 0, 0}, {0, 0, 0}}};
  simulation.external = {load};
  simulation.times = {0, 1, 2, 5, 10};
  const SimulationResult result = Simulate(simulation);
  Print("slider-crank", result);
  for (size_t i = 0; i < result.size(); ++i) {
    const auto& p = result.loads.poses.arrays();
    std::printf("  %.3f  %.12f %.12f %.3e\n", result.times[i],
                p.Joint(i, joint("main")).position[0], p.Joint(i, joint("guide")).position[0],
                result.energies[i].error);
  }
}

}  // namespace
}  // namespace vmech
