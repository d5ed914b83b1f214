// What the fast solvers add to the evaluations of their problem; instruction budgets watch it.

#include <memory>
#include <vector>

#include "kernels.h"
#include "vmech/solvers/augmented_lagrangian.h"
#include "vmech/solvers/penalty.h"

namespace vmech {
namespace {

/// Of the sizes of a slider-crank in space with a rigid grasp: 3 unknowns, 6 residuals, 5 loop
/// equations. Mildly curved, and so cheap that hardly anything but the solver is measured.
class SmallProblem final : public ConstrainedLeastSquares {
 public:
  SmallProblem() : ConstrainedLeastSquares({3, 3, 6, 5}) {
    for (int i = 0; i < J_.size(); ++i) J_.data()[i] = 1 / (1.0 + (7 * i) % 11);
    for (int i = 0; i < C_.size(); ++i) C_.data()[i] = 1 / (1.0 + (5 * i) % 7);
  }

  void Evaluate(const VectorXd& x, VectorXd* r, MatrixXd* J, VectorXd* c, MatrixXd* C) override {
    const Eigen::Vector3d d = x.head<3>() - Eigen::Vector3d::Constant(target);
    const double bend = 1 + 0.1 * d.squaredNorm();
    if (r) r->head<6>().noalias() = bend * (J_ * d);
    if (J) J->topLeftCorner<6, 3>().noalias() = bend * J_;
    if (c) c->head<5>().noalias() = bend * (C_ * d);
    if (C) C->topLeftCorner<5, 3>().noalias() = bend * C_;
  }
  void Plus(const VectorXd& x, const VectorXd& dx, VectorXd* x_plus) const override {
    x_plus->head<3>() = x.head<3>() + dx.head<3>();
  }

  double target = 0;

 private:
  Eigen::Matrix<double, 6, 3> J_;
  Eigen::Matrix<double, 5, 3> C_;
};

template <typename Options, typename Workspace>
struct Tracking {
  SmallProblem problem;
  Options options;
  Workspace workspace{problem};
  VectorXd x = VectorXd::Zero(3);

  // The target goes to and fro, so that there is something to do in every call.
  void MoveTarget() { problem.target = problem.target > 0 ? 0 : 0.01; }
};
using PenaltyTracking = Tracking<PenaltyOptions, PenaltyWorkspace>;

std::function<void()> Evaluation() {
  auto state = std::make_shared<Linearization>(ProblemSizes{3, 3, 6, 5});
  auto problem = std::make_shared<SmallProblem>();
  return [state, problem, x = VectorXd(VectorXd::Ones(3))] { state->Evaluate(*problem, x); };
}

std::function<void()> PenaltyStep() {
  auto state = std::make_shared<PenaltyTracking>();
  return [state] {
    state->MoveTarget();
    if (!Step(state->problem, state->options, &state->x, &state->workspace).ok) std::abort();
  };
}

std::function<void()> PenaltySolve() {
  auto state = std::make_shared<PenaltyTracking>();
  return [state] {
    state->MoveTarget();
    const FastOutcome outcome = Solve(state->problem, state->options, &state->x, &state->workspace);
    if (outcome.claim != SolveStatus::kBiased) std::abort();
  };
}

}  // namespace
}  // namespace vmech

int main(int argc, char** argv) {
  return vmech::RunKernel({{"evaluation", vmech::Evaluation},
                           {"penalty_step", vmech::PenaltyStep},
                           {"penalty_solve", vmech::PenaltySolve}},
                          argc, argv);
}
