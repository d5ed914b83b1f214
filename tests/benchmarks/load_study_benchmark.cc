// What a loads study costs, and how that grows with the number of poses and of loops.

#include <benchmark/benchmark.h>

#include "benchmark_studies.h"
#include "vmech/dynamics/loads/load_study.h"
#include "vmech/dynamics/loads/run_load_study.h"

namespace vmech {
namespace {

void CountPoses(benchmark::State& state, size_t poses) {
  state.counters["poses"] = benchmark::Counter(static_cast<double>(state.iterations() * poses),
                                               benchmark::Counter::kIsRate);
  state.counters["per_pose"] =
      benchmark::Counter(static_cast<double>(state.iterations() * poses),
                         benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}

void SliderCrankPoses(benchmark::State& state) {
  const LoadStudy study = SliderCrankStudy(static_cast<int>(state.range(0)));
  for (auto _ : state) benchmark::DoNotOptimize(RunLoadStudy(study, JointLoadsOnly()));
  CountPoses(state, study.times.size());
  state.SetComplexityN(state.range(0));
}
BENCHMARK(SliderCrankPoses)->RangeMultiplier(4)->Range(720, 720 * 64)->Complexity();

void WindowFourBarPoses(benchmark::State& state) {
  const LoadStudy study = WindowStudy(static_cast<int>(state.range(0)), 720);
  for (auto _ : state) benchmark::DoNotOptimize(RunLoadStudy(study, JointLoadsOnly()));
  CountPoses(state, study.times.size());
  state.SetComplexityN(state.range(0));
}
BENCHMARK(WindowFourBarPoses)
    ->Arg(1)
    ->Arg(2)
    ->Arg(5)
    ->Arg(10)
    ->Arg(20)
    ->Arg(40)
    ->Complexity()
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace vmech
