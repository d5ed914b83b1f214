#include <gtest/gtest.h>

#include <Eigen/QR>
#include <algorithm>
#include <stdexcept>

#include "support/needs.h"
#include "textbook_problems.h"
#include "vmech/solvers/backend.h"

namespace vmech::every_backend_test {
namespace {

using textbook::FindProblem;
using textbook::InfeasibleProblems;
using textbook::TextbookProblem;
using textbook::TextbookProblems;

constexpr double kObjectiveTolerance = 1e-8;

// Gauss-Newton is slow on HS27, where all curvature comes from the multiplier.
StoppingRule Patient() {
  StoppingRule rule;
  rule.max_iterations = 5000;
  return rule;
}

/// What a back end can be held to.
struct Accuracy {
  bool exact = true;    ///< meets the stopping rule, so that its status is kConverged
  double solution = 0;  ///< of x, the objective and multipliers, beyond what the problem allows
  double closure = 0;   ///< of c
  double flatness = 1;  ///< times what the problem allows: some stop early where it is flat
};

Accuracy AccuracyOf(Backend backend) {
  switch (backend) {
    // lambda = 1000 moves the solution by about multiplier / lambda^2.
    case Backend::kPenalty:
    case Backend::kCeresWeighted:
      return {false, 1e-4, 1e-4};
    // These stop where the objective no longer changes, which is flat about a minimum.
    case Backend::kNloptSlsqp:
    case Backend::kNloptAuglagLbfgs:
      return {false, 1e-5, 1e-8};
    // Follows no curvature: some of its runs end with their evaluations.
    case Backend::kNloptAuglagMma:
      return {false, 1e-5, 1e-4, 3};
    // Sees differences of values only.
    case Backend::kNloptAuglagCobyla:
      return {false, 5e-3, 1e-4, 5};
    default:
      return {};
  }
}

/// Does a bound hold the solution? KINSOL finds roots and can only say that it cannot.
bool HasActiveBound(const ConstrainedLeastSquares& problem, const VectorXd& solution) {
  constexpr double kOnTheBound = 1e-6;
  return std::any_of(problem.bounds().begin(), problem.bounds().end(), [&](const Bound& bound) {
    const double x = solution[bound.coordinate];
    return x - bound.lower < kOnTheBound || bound.upper - x < kOnTheBound;
  });
}

class EveryProblemEveryBackend : public ::testing::TestWithParam<std::tuple<int, Backend>> {};

TEST_P(EveryProblemEveryBackend, FindsTheKnownSolution) {
  const auto& [index, backend] = GetParam();
  const TextbookProblem& known = TextbookProblems()[index];
  const auto problem = known.make();
  const Summary summary = Solve(backend, *problem, Patient(), known.start);
  VMECH_NEEDS(summary.status != SolveStatus::kUnavailable, summary.message);
  SCOPED_TRACE(summary.FullReport());
  if (backend == Backend::kKinsol && known.solution.size() > 0 &&
      HasActiveBound(*problem, known.solution)) {
    EXPECT_EQ(summary.status, SolveStatus::kUnsuitable);
    return;
  }
  if (backend == Backend::kNloptAuglagCobyla && known.name == "HS50") {
    // It makes no step longer than its first, and HS50 starts far away.
    EXPECT_FALSE(summary.converged());
    return;
  }
  const Accuracy accuracy = AccuracyOf(backend);
  if (accuracy.exact) {
    EXPECT_EQ(summary.status, SolveStatus::kConverged);
  } else {
    EXPECT_NE(summary.status, SolveStatus::kFailed);
    EXPECT_LT(summary.constraint_norm, accuracy.closure);
  }
  EXPECT_NEAR(summary.objective, known.objective, kObjectiveTolerance + accuracy.solution);
  if (known.solution.size() > 0) {
    EXPECT_LT((summary.x - known.solution).cwiseAbs().maxCoeff(),
              accuracy.flatness * known.solution_tolerance + accuracy.solution);
  }
}

std::string ParameterName(const ::testing::TestParamInfo<std::tuple<int, Backend>>& info) {
  return TextbookProblems()[std::get<0>(info.param)].name + "_" +
         std::string(NameOf(std::get<1>(info.param)));
}

INSTANTIATE_TEST_SUITE_P(
    Textbook, EveryProblemEveryBackend,
    ::testing::Combine(::testing::Range(0, static_cast<int>(TextbookProblems().size())),
                       ::testing::ValuesIn(kAllBackends)),
    ParameterName);

class EveryBackend : public ::testing::TestWithParam<Backend> {};

// The packages may stop on the way to where |c| is least; what matters is that nobody calls it
// solved.
bool IsOwn(Backend backend) {
  return backend == Backend::kPenalty || backend == Backend::kAugmentedLagrangian ||
         backend == Backend::kNullspace;
}

TEST_P(EveryBackend, NeverCallsAnInfeasibleProblemSolved) {
  for (const TextbookProblem& impossible : InfeasibleProblems()) {
    const Summary summary = Solve(GetParam(), *impossible.make(), StoppingRule{}, impossible.start);
    VMECH_NEEDS(summary.status != SolveStatus::kUnavailable, summary.message);
    SCOPED_TRACE(impossible.name + "\n" + summary.FullReport());
    if (IsOwn(GetParam())) {
      EXPECT_EQ(summary.status, SolveStatus::kInfeasible);
    }
    EXPECT_FALSE(summary.converged());
    EXPECT_GT(std::max(summary.constraint_norm, summary.bound_violation), 0.1);
    EXPECT_TRUE(summary.x.allFinite());
  }
}

TEST_P(EveryBackend, RefusesAStartOfTheWrongSize) {
  const auto problem = FindProblem("HS6").make();
  EXPECT_THROW(Solve(GetParam(), *problem, StoppingRule{}, VectorXd::Zero(3)),
               std::invalid_argument);
}

TEST_P(EveryBackend, IsFoundByItsName) {
  EXPECT_EQ(BackendFromName(NameOf(GetParam())), GetParam());
}

// At the four-bar's solution J'r + C'mu = 0 has one answer, C being of full rank.
TEST_P(EveryBackend, ReturnsMultipliersThatBalanceTheGradient) {
  const TextbookProblem& known = FindProblem("FourBarPulledOffItsPath");
  const auto problem = known.make();
  const Summary summary = Solve(GetParam(), *problem, StoppingRule{}, known.start);
  VMECH_NEEDS(summary.status != SolveStatus::kUnavailable, summary.message);
  VectorXd r(2), c(2);
  MatrixXd J(2, 3), C(2, 3);
  problem->Evaluate(known.solution, &r, &J, &c, &C);
  const VectorXd mu = C.transpose().colPivHouseholderQr().solve(-J.transpose() * r);
  const Accuracy accuracy = AccuracyOf(GetParam());
  const double tolerance = accuracy.exact ? 1e-8 : accuracy.solution;
  EXPECT_LT((summary.multipliers - mu).norm(), tolerance) << summary.FullReport();
}

INSTANTIATE_TEST_SUITE_P(All, EveryBackend, ::testing::ValuesIn(kAllBackends),
                         [](const auto& info) { return std::string(NameOf(info.param)); });

}  // namespace
}  // namespace vmech::every_backend_test
