// Inverse kinematics in the fast path, which instruction budgets watch.

#include <memory>
#include <string>

#include "hand_path.h"
#include "kernels.h"
#include "vmech/solvers/backend.h"
#include "vmech/solvers/nullspace.h"
#include "vmech/solvers/penalty.h"

namespace vmech {
namespace {

template <typename Workspace>
struct State {
  HandPath path = SliderCrankPath();
  InverseKinematics problem = path.Problem();
  Workspace workspace{problem};
  VectorXd x = path.start();
  Linearization at_x{problem.sizes()};
};

/// The slider-crank's grasp and loop errors with their Jacobians, at another pose every time.
std::function<void()> SliderCrankEvaluation() {
  auto state = std::make_shared<State<PenaltyWorkspace>>();
  return [state] {
    state->x[0] += 1e-6;
    state->at_x.Evaluate(state->problem, state->x);
  };
}

/// A warm-started solve of the slider-crank in place.
template <typename Options, typename Workspace, SolveStatus kClaim>
std::function<void()> SliderCrankSolve() {
  auto state = std::make_shared<State<Workspace>>();
  return [state, options = Options()] {
    state->problem.SetTarget(state->path.Next());
    const FastOutcome outcome = Solve(state->problem, options, &state->x, &state->workspace);
    if (outcome.claim != kClaim) std::abort();
  };
}
constexpr auto SliderCrankPenalty =
    SliderCrankSolve<PenaltyOptions, PenaltyWorkspace, SolveStatus::kBiased>;
constexpr auto SliderCrankNullspace =
    SliderCrankSolve<NullspaceOptions, NullspaceWorkspace, SolveStatus::kConverged>;

/// The same by name and judged, of which callgrind tells how much is the package's own.
std::function<void()> SliderCrankByName(Backend backend) {
  auto state = std::make_shared<State<PenaltyWorkspace>>();
  return [state, backend] {
    state->problem.SetTarget(state->path.Next());
    const Summary summary = Solve(backend, state->problem, StoppingRule{}, state->x);
    if (summary.status == SolveStatus::kUnavailable) std::abort();
    state->x = summary.x;
  };
}

Kernels AllKernels() {
  Kernels kernels = {{"slider_crank_evaluation", SliderCrankEvaluation},
                     {"slider_crank_nullspace", SliderCrankNullspace},
                     {"slider_crank_penalty", SliderCrankPenalty}};
  for (const Backend backend : kAllBackends) {
    kernels["slider_crank_by_" + std::string(NameOf(backend))] = [backend] {
      return SliderCrankByName(backend);
    };
  }
  return kernels;
}

}  // namespace
}  // namespace vmech

int main(int argc, char** argv) {
  return vmech::RunKernel(vmech::AllKernels(), argc, argv);
}
