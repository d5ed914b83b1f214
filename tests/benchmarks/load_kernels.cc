// Work of the load study that instruction budgets watch.

#include <memory>

#include "benchmark_studies.h"
#include "kernels.h"
#include "vmech/dynamics/load_model.h"

namespace vmech {
namespace {

/// One closed pose of the slider-crank in space: velocities, accelerations, every joint wrench.
std::function<void()> SliderCrankPose() {
  struct State {
    LoadStudy study = SliderCrankStudy(720);
    PreparedStudy prepared = PrepareStudy(study);
    std::vector<PoseInput> inputs = TrackMotion(study, prepared, 1e-13);
    LoadWorkspace ws{prepared.model};
    PoseLoads loads;
    size_t next = 0;
  };
  auto state = std::make_shared<State>();
  SizePoseLoads(state->prepared.model, &state->loads);
  return [state] {
    const PoseInput& input = state->inputs[state->next++ % state->inputs.size()];
    if (!EvaluatePoseLoads(state->prepared.model, input, &state->ws, &state->loads)) std::abort();
  };
}

}  // namespace
}  // namespace vmech

int main(int argc, char** argv) {
  return vmech::RunKernel({{"slider_crank_pose", vmech::SliderCrankPose}}, argc, argv);
}
