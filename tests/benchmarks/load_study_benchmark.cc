// What a loads study costs, and how that grows with the number of poses and of loops.

#include <benchmark/benchmark.h>

#include <string>
#include <vector>

#include "benchmark_studies.h"
#include "vmech/dynamics/loads/load_study.h"
#include "vmech/dynamics/loads/prepare_study.h"
#include "vmech/dynamics/loads/run_load_study.h"
#include "vmech/dynamics/loads/track_motion.h"
#include "vmech/dynamics/sensitivity/load_derivatives.h"
#include "vmech/dynamics/sensitivity/study_change.h"
#include "vmech/studies/sensitivities.h"
#include "vmech/studies/study_reader.h"

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

/// The derivatives of all loads of the slider-crank, 720 poses, by 20 masses and places, one by
/// one.
void SliderCrankGradient(benchmark::State& state) {
  const LoadStudy study = SliderCrankStudy(720);
  const PreparedStudy prepared = PrepareStudy(study);
  const Motion motion = TrackMotion(study, prepared, LoadStudyOptions().closure_tolerance);
  std::vector<StudyChange> changes;
  for (int parameter = 0; parameter < 20; ++parameter) {
    const auto at = [&](double by) {
      LoadStudy changed = study;
      Link& link = changed.mechanism.links[static_cast<size_t>(parameter % 4)];
      link.mass_properties.mass += by;
      link.mass_properties.p_LoLcm.x() += by * parameter;
      for (Anchor& anchor : link.anchors) anchor.X_LA.p.x() += by;
      return changed;
    };
    changes.push_back(ChangeOfStudy(prepared, motion, at, 0, 1e-4));
  }
  for (auto _ : state) {
    for (const StudyChange& change : changes) {
      benchmark::DoNotOptimize(DifferentiateLoads(prepared, motion, change));
    }
  }
}
BENCHMARK(SliderCrankGradient)->Unit(benchmark::kMillisecond);

/// The first parameters of a study that have derivatives.
std::vector<StudyParameter> ParametersWithSlopes(const StudyFile& file, const StudyOutcome& outcome,
                                                 const std::vector<Figure>& figures, size_t count) {
  const Sensitivities all = FindSensitivities(file, outcome, figures, DimensionsOf(file, true));
  std::vector<StudyParameter> parameters;
  for (size_t p = 0; p < all.parameters.size() && parameters.size() < count; ++p) {
    if (all.refusals[p].empty()) parameters.push_back(all.parameters[p]);
  }
  return parameters;
}

/// Figures of the study of the slider-crank, 720 poses, by 20 dimensions: values and derivatives.
void SliderCrankFigures(benchmark::State& state, const std::vector<std::string>& names) {
  const StudyFile file = ReadStudy(VMECH_EXAMPLES "/slider-crank-study.yaml");
  const StudyOutcome outcome = RunStudy(file, {});
  std::vector<Figure> figures;
  for (const std::string& name : names) {
    figures.push_back(FindFigure(FiguresOf(file, outcome), name));
  }
  const std::vector<StudyParameter> parameters = ParametersWithSlopes(file, outcome, figures, 20);
  for (auto _ : state) {
    benchmark::DoNotOptimize(FindSensitivities(file, outcome, figures, parameters));
  }
  state.counters["parameters"] = static_cast<double>(parameters.size());
}
BENCHMARK_CAPTURE(SliderCrankFigures, Peak, {"pin.force"})->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(SliderCrankFigures, Peaks, {"pin.force", "wrist.force", "main.drive"})
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(SliderCrankFigures, Rms, {"pin.force.rms"})->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(SliderCrankFigures, Life, {"pin.life"})->Unit(benchmark::kMillisecond);

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
