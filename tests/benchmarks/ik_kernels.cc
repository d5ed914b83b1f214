// Inverse kinematics in the fast path, which instruction budgets watch.

#include <memory>

#include "hand_path.h"
#include "kernels.h"
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

}  // namespace
}  // namespace vmech

int main(int argc, char** argv) {
  return vmech::RunKernel({{"slider_crank_evaluation", vmech::SliderCrankEvaluation},
                           {"slider_crank_nullspace", vmech::SliderCrankNullspace},
                           {"slider_crank_penalty", vmech::SliderCrankPenalty}},
                          argc, argv);
}
