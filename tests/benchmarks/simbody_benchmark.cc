// The loads of the slider-crank beside Simbody in the same run: every joint's wrench and the drive
// torque at the same poses. Simbody is given the closed poses and velocities that vmech has to find
// for itself, a loop without redundant equations, and its drive as prescribed motion: the fastest
// way found to have the same answer from it.

#include <benchmark/benchmark.h>

#include <chrono>
#include <cmath>

#include "benchmark_studies.h"
#include "simbody_model.h"

#include "vmech/dynamics/loads/load_result.h"
#include "vmech/dynamics/loads/run_load_study.h"

namespace vmech {
namespace {

std::vector<peers::SimbodyQuery> QueriesOf(const LoadStudyResult& result) {
  std::vector<peers::SimbodyQuery> queries;
  for (const PoseLoads& pose : result.poses) {
    peers::SimbodyQuery query;
    for (const LinkMotion& link : pose.links) query.links.push_back({link.X_WL, link.v, link.w});
    query.drives = {pose.drives[0].acceleration};
    queries.push_back(query);
  }
  return queries;
}

double SecondsSince(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

// Both sides over all poses in every iteration; the counters are microseconds per pose and how many
// times as long Simbody takes.
void SliderCrankBesideSimbody(benchmark::State& state) {
  const LoadStudy study = SliderCrankStudy(static_cast<int>(state.range(0)));
  const LoadStudyResult reference = RunLoadStudy(study);
  const std::vector<peers::SimbodyQuery> queries = QueriesOf(reference);
  peers::SimbodyModel peer(study.mechanism, {{study.drives[0].joint, 0}},
                           peers::DriveMode::kAcceleration);
  peer.DropRedundantEquations(queries[0].links);
  peers::SimbodyAnswer answer;
  double own = 0, others = 0;
  for (auto _ : state) {
    auto start = std::chrono::steady_clock::now();
    benchmark::DoNotOptimize(RunLoadStudy(study, JointLoadsOnly()));
    own += SecondsSince(start);
    start = std::chrono::steady_clock::now();
    for (const peers::SimbodyQuery& query : queries) peer.Evaluate(query, &answer);
    others += SecondsSince(start);
  }
  const double torque = reference.poses.back().drives[0].force;
  if (std::abs(answer.drive_forces[0] - torque) > 1e-6 * std::abs(torque)) {
    state.SkipWithError("the two sides disagree on the drive torque");
  }
  const double poses = static_cast<double>(state.iterations() * queries.size());
  state.counters["vmech_us"] = 1e6 * own / poses;
  state.counters["simbody_us"] = 1e6 * others / poses;
  state.counters["ratio"] = others / own;
}
BENCHMARK(SliderCrankBesideSimbody)->Arg(7200)->MinWarmUpTime(0.5)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace vmech
