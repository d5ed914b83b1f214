// Inverse kinematics in the fast path, which instruction budgets watch.

#include <memory>

#include "hand_path.h"
#include "kernels.h"
#include "vmech/solvers/penalty.h"

namespace vmech {
namespace {

struct State {
  HandPath path = SliderCrankPath();
  InverseKinematics problem = path.Problem();
  PenaltyWorkspace workspace{problem};
  PenaltyOptions options;
  VectorXd x = path.start();
  Linearization at_x{problem.sizes()};
};

/// The slider-crank's grasp and loop errors with their Jacobians, at another pose every time.
std::function<void()> SliderCrankEvaluation() {
  auto state = std::make_shared<State>();
  return [state] {
    state->x[0] += 1e-6;
    state->at_x.Evaluate(state->problem, state->x);
  };
}

/// A warm-started solve of the slider-crank by the penalty.
std::function<void()> SliderCrankPenalty() {
  auto state = std::make_shared<State>();
  return [state] {
    state->problem.SetTarget(state->path.Next());
    const FastOutcome outcome = Solve(state->problem, state->options, &state->x, &state->workspace);
    if (outcome.claim != SolveStatus::kBiased) std::abort();
  };
}

}  // namespace
}  // namespace vmech

int main(int argc, char** argv) {
  return vmech::RunKernel({{"slider_crank_evaluation", vmech::SliderCrankEvaluation},
                           {"slider_crank_penalty", vmech::SliderCrankPenalty}},
                          argc, argv);
}
