// What a warm-started solve of inverse kinematics costs with every back end: the hand leads the
// slider-crank along its path, within reach and 1 mm out of it, and the four-bar with N windows.

#include <string>

#include "benchmark_statistics.h"
#include "hand_path.h"
#include "vmech/solvers/augmented_lagrangian.h"
#include "vmech/solvers/backend.h"
#include "vmech/solvers/nullspace.h"
#include "vmech/solvers/penalty.h"

namespace vmech {
namespace {

constexpr double kPull = 1e-3;  // [m]

/// As a real-time loop calls it: memory is taken before, nothing is judged after.
template <typename Options, typename Workspace>
void SolveInPlace(benchmark::State& state, HandPath path) {
  InverseKinematics problem = path.Problem();
  Workspace workspace(problem);
  const Options options;
  VectorXd x = path.start();
  double iterations = 0;
  for (auto _ : state) {
    problem.SetTarget(path.Next());
    const FastOutcome outcome = Solve(problem, options, &x, &workspace);
    if (outcome.claim == SolveStatus::kStalled) state.SkipWithError("stalled");
    iterations += outcome.iterations;
  }
  state.counters["iterations"] = benchmark::Counter(iterations, benchmark::Counter::kAvgIterations);
}

template <typename Options, typename Workspace>
void StepInPlace(benchmark::State& state, HandPath path) {
  InverseKinematics problem = path.Problem();
  Workspace workspace(problem);
  const Options options;
  VectorXd x = path.start();
  for (auto _ : state) {
    problem.SetTarget(path.Next());
    if (!Step(problem, options, &x, &workspace).ok) state.SkipWithError("not finite");
  }
}

/// By name, judged: as a comparison calls it.
void SolveByName(benchmark::State& state, Backend backend, HandPath path) {
  InverseKinematics problem = path.Problem();
  VectorXd x = path.start();
  double evaluations = 0, converged = 0;
  for (auto _ : state) {
    problem.SetTarget(path.Next());
    const Summary summary = Solve(backend, problem, StoppingRule{}, x);
    x = summary.x;
    evaluations += summary.evaluations;
    converged += summary.converged();
  }
  state.counters["evaluations"] =
      benchmark::Counter(evaluations, benchmark::Counter::kAvgIterations);
  state.counters["converged"] = benchmark::Counter(converged, benchmark::Counter::kAvgIterations);
}

template <typename... Arguments>
benchmark::internal::Benchmark* Register(const std::string& name, Arguments&&... arguments) {
  return benchmark::RegisterBenchmark(name.c_str(), std::forward<Arguments>(arguments)...);
}

void RegisterInPlace(const std::string& prefix, const HandPath& path) {
  Register(prefix + "/penalty_step", StepInPlace<PenaltyOptions, PenaltyWorkspace>, path)
      ->Apply(ReportPercentiles);
  Register(prefix + "/penalty_in_place", SolveInPlace<PenaltyOptions, PenaltyWorkspace>, path)
      ->Apply(ReportPercentiles);
  Register(prefix + "/augmented_lagrangian_in_place",
           SolveInPlace<AugmentedLagrangianOptions, AugmentedLagrangianWorkspace>, path)
      ->Apply(ReportPercentiles);
  Register(prefix + "/nullspace_in_place", SolveInPlace<NullspaceOptions, NullspaceWorkspace>, path)
      ->Apply(ReportPercentiles);
}

void MedianOfFew(benchmark::internal::Benchmark* benchmark) {
  benchmark->Repetitions(9)->MinTime(0.05)->ReportAggregatesOnly(true)->Unit(
      benchmark::kMicrosecond);
}

void RegisterEveryBackend(const std::string& prefix, const HandPath& path) {
  for (Backend backend : kAllBackends) {
    Register(prefix + "/" + std::string(NameOf(backend)), SolveByName, backend, path)
        ->Apply(MedianOfFew);
  }
}

void RegisterAll() {
  RegisterInPlace("slider_crank", SliderCrankPath());
  RegisterEveryBackend("slider_crank", SliderCrankPath());
  RegisterInPlace("slider_crank_pulled", SliderCrankPath(kPull));
  RegisterEveryBackend("slider_crank_pulled", SliderCrankPath(kPull));
  for (int windows : {1, 2, 5, 10}) {
    const std::string prefix = "windows_" + std::to_string(windows);
    RegisterInPlace(prefix, WindowPath(windows));
    RegisterEveryBackend(prefix, WindowPath(windows));
  }
}

}  // namespace
}  // namespace vmech

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  vmech::RegisterAll();
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
