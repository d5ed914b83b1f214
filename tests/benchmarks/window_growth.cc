// Plots what one pose of the N-window four-bar costs as N grows: `window_growth growth.svg`.

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <fstream>

#include "benchmark_studies.h"
#include "vmech/apps/plot/line_plot.h"
#include "vmech/apps/plot/style.h"
#include "vmech/base/packet.h"
#include "vmech/dynamics/loads/load_result.h"
#include "vmech/dynamics/loads/prepare_study.h"
#include "vmech/dynamics/loads/track_motion.h"
#include "vmech/dynamics/loads/pose/pose_loads.h"

namespace vmech {
namespace {

/// Median time of one pose [us]: tracked, and all joint wrenches found.
double MicrosecondsPerPose(int windows) {
  constexpr int kPoses = 400, kRepetitions = 9;
  const LoadStudy study = WindowStudy(windows, kPoses);
  const PreparedStudy prepared = PrepareStudy(study);
  LoadWorkspace<Packet> ws(prepared.model);
  std::vector<PoseLoads> loads(Packet::kLanes);
  std::vector<double> times;
  for (int i = 0; i < kRepetitions; ++i) {
    const auto start = std::chrono::steady_clock::now();
    const Motion motion = TrackMotion(study, prepared, 1e-13);
    for (size_t pose = 0; pose < motion.size(); pose += Packet::kLanes) {
      if (!EvaluatePoseLoads(prepared.model, motion, pose, &ws)) return 0;
      StorePoseLoads(prepared.model, motion, pose, ws, false, loads.data());
    }
    const std::chrono::duration<double, std::micro> elapsed =
        std::chrono::steady_clock::now() - start;
    times.push_back(elapsed.count() / kPoses);
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
  for (int windows : {1, 2, 5, 10, 20, 40}) {
    measured.x.push_back(windows);
    measured.y.push_back(MicrosecondsPerPose(windows));
    fmt::print("N = {:2}: {:7.2f} us per pose, {:.2f} us per window\n", windows, measured.y.back(),
               measured.y.back() / windows);
  }
  plot.series.push_back(measured);
  plot.series.push_back({"linear in N",
                         {1, 40},
                         {measured.y.back() / 40, measured.y.back()},
                         plot::LineStyle::kDashed});
  std::ofstream(argv[1]) << plot::StandaloneSvg(plot::Draw(plot));
  return 0;
}

}  // namespace
}  // namespace vmech

int main(int argc, char** argv) {
  return vmech::Main(argc, argv);
}
