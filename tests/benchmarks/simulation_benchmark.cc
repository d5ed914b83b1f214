// Forward dynamics: one evaluation of the accelerations, and whole runs from file to result.

#include <benchmark/benchmark.h>

#include <string>

#include "reference_cases.h"
#include "support/examples.h"
#include "vmech/dynamics/simulation/equations/equations_of_motion.h"
#include "vmech/dynamics/simulation/simulate.h"

namespace vmech {
namespace {

Simulation With(const Mechanism& mechanism, double end) {
  Simulation simulation;
  simulation.mechanism = mechanism;
  simulation.times = {0, end};
  return simulation;
}

void Accelerations(benchmark::State& state, const Simulation& simulation) {
  const PreparedSimulation prepared = PrepareSimulation(simulation);
  EquationsOfMotion equations(prepared);
  VectorXd y = VectorXd::Zero(equations.size()), slopes = y;
  y.head(prepared.q.size()) = prepared.q;
  for (auto _ : state) {
    equations.Slopes(0, y.data(), slopes.data());
    benchmark::DoNotOptimize(slopes.data());
  }
}

void WholeRun(benchmark::State& state, const Simulation& simulation) {
  SimulationOptions options;
  options.loads = false;
  SimulationResult result;
  for (auto _ : state) result = Simulate(simulation, options);
  state.counters["integration_ms"] = 1e3 * result.statistics.seconds;
  state.counters["steps"] = static_cast<double>(result.statistics.steps);
  state.counters["evaluations"] = static_cast<double>(result.statistics.evaluations);
}

void OfWindows(benchmark::State& state) {
  Accelerations(state, FallingWindows(static_cast<int>(state.range(0)), {0, 1}));
}

BENCHMARK_CAPTURE(Accelerations, andrews, AndrewsSqueezer());
BENCHMARK_CAPTURE(Accelerations, bricard, With(Example("bricard"), 10));
BENCHMARK_CAPTURE(Accelerations, puma_560, With(Example("puma-560"), 1));
BENCHMARK(OfWindows)->RangeMultiplier(2)->Range(5, 80);
BENCHMARK_CAPTURE(WholeRun, andrews, AndrewsSqueezer())->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(WholeRun, bricard, With(Example("bricard"), 10))->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(WholeRun, windows, FallingWindows(40, {0, 10}))->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace vmech
