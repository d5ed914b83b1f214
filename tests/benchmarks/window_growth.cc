// Plots what one pose of the N-window four-bar costs as N grows: `window_growth growth.svg`.

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <fstream>

#include "benchmark_studies.h"
#include "vmech/apps/plot/line_plot.h"
#include "vmech/apps/plot/style.h"
#include "vmech/dynamics/loads/load_result.h"
#include "vmech/dynamics/loads/prepare_study.h"
#include "vmech/dynamics/loads/run_load_study.h"

namespace vmech {
namespace {

double SecondsSince(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// Median time [us] of one pose of a prepared study: tracked, all joint wrenches found and stored,
/// and its share of the checks and verdicts of the study.
double MicrosecondsPerPose(const LoadStudy& study, const PreparedStudy& prepared) {
  constexpr int kRepetitions = 9;
  std::vector<double> times;
  for (int i = 0; i < kRepetitions; ++i) {
    const auto start = std::chrono::steady_clock::now();
    const LoadStudyResult result = RunLoadStudy(study, prepared, JointLoadsOnly());
    times.push_back(1e6 * SecondsSince(start) / static_cast<double>(result.poses.size()));
  }
  std::nth_element(times.begin(), times.begin() + kRepetitions / 2, times.end());
  return times[kRepetitions / 2];
}

int Main(int argc, char** argv) {
  if (argc != 2) {
    fmt::print(stderr, "usage: {} FILE.svg\n", argv[0]);
    return 1;
  }
  plot::LinePlot plot;
  plot.title = "Cost of a pose of the N-window four-bar";
  plot.x = {"windows N", "", plot::ScaleType::kLog};
  plot.y = {"time", "us", plot::ScaleType::kLog};
  plot::Series measured{"measured", {}, {}};
  measured.marker = plot::Marker::kCircle;
  constexpr int kPoses = 400, kMostWindows = 200;
  for (int windows : {1, 2, 5, 10, 20, 40, 80, kMostWindows}) {
    const LoadStudy study = WindowStudy(windows, kPoses);
    const auto start = std::chrono::steady_clock::now();
    const PreparedStudy prepared = PrepareStudy(study);
    const double preparation = SecondsSince(start);
    measured.x.push_back(windows);
    measured.y.push_back(MicrosecondsPerPose(study, prepared));
    fmt::print("N = {:3}: {:7.2f} us per pose, {:.3f} us per window; once {:.2f} ms\n", windows,
               measured.y.back(), measured.y.back() / windows, 1e3 * preparation);
  }
  plot.series.push_back(measured);
  plot.series.push_back({"linear in N",
                         {1, kMostWindows},
                         {measured.y.back() / kMostWindows, measured.y.back()},
                         plot::LineStyle::kDashed});
  std::ofstream(argv[1]) << plot::StandaloneSvg(plot::Draw(plot));
  return 0;
}

}  // namespace
}  // namespace vmech

int main(int argc, char** argv) {
  return vmech::Main(argc, argv);
}
