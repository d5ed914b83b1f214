// Work of the load study that instruction budgets watch.

#include <memory>

#include "benchmark_studies.h"
#include "kernels.h"
#include "vmech/base/lanes4.h"
#include "vmech/dynamics/loads/load_result.h"
#include "vmech/dynamics/loads/pose/pose_loads.h"
#include "vmech/dynamics/loads/pose/store_pose_loads.h"
#include "vmech/dynamics/loads/prepare_study.h"
#include "vmech/dynamics/loads/track_motion.h"

namespace vmech {
namespace {

/// Closed poses of the slider-crank in space, as many at a time as T has lanes: velocities,
/// accelerations, every joint wrench.
template <typename T>
std::function<void()> SliderCrankPose() {
  struct State {
    LoadStudy study = SliderCrankStudy(720);
    PreparedStudy prepared = PrepareStudy(study);
    Motion motion = TrackMotion(study, prepared, 1e-13);
    LoadWorkspace<T> ws{prepared.model};
    LoadArrays loads = MakeLoadArrays(prepared.model, motion, false);
    size_t next = 0;
  };
  auto state = std::make_shared<State>();
  return [state] {
    const LoadModel& model = state->prepared.model;
    const size_t pose = state->next;
    if (!EvaluatePoseLoads(model, state->motion, pose, &state->ws)) std::abort();
    StorePoseLoads(model, state->motion, pose, state->ws, &state->loads);
    state->next = (pose + kLanesOf<T>) % state->motion.size();
  };
}

/// A tenth of these poses, followed from one to the next.
std::function<void()> SliderCrankTrack() {
  struct State {
    LoadStudy study = SliderCrankStudy(720);
    PreparedStudy prepared = PrepareStudy(study);
  };
  auto state = std::make_shared<State>();
  state->study.times.resize(72);
  return [state] { TrackMotion(state->study, state->prepared, 1e-13); };
}

}  // namespace
}  // namespace vmech

int main(int argc, char** argv) {
  return vmech::RunKernel({{"slider_crank_pose", vmech::SliderCrankPose<double>},
                           {"slider_crank_packet", vmech::SliderCrankPose<vmech::Lanes4>},
                           {"slider_crank_track", vmech::SliderCrankTrack}},
                          argc, argv);
}
