#include "vmech/solvers/optimality.h"

#include <gtest/gtest.h>

#include "support/needs.h"
#include "textbook_problems.h"
#include "vmech/solvers/backend.h"

namespace vmech::optimality_test {
namespace {

using textbook::FindProblem;
using textbook::TextbookProblem;

Optimality At(const std::string& name, const VectorXd& x) {
  const auto problem = FindProblem(name).make();
  Linearization at_x(problem->sizes());
  at_x.Evaluate(*problem, x);
  return MeasureOptimality(problem->bounds(), x, at_x);
}

constexpr double kRounding = 1e-12;

TEST(Optimality, VanishesAtAKnownMinimum) {
  const Optimality at = At("HS42", FindProblem("HS42").solution);
  EXPECT_LT(at.kkt_error, kRounding);
  EXPECT_LT(at.constraint_norm, kRounding);
  // r1 + mu1 = 0 with r1 = 1; (0.6 s - 3) + 2 mu2 0.6 s = 0 with s = sqrt(2)
  EXPECT_NEAR(at.multipliers[0], -1, kRounding);
  EXPECT_NEAR(at.multipliers[1], 2.5 / std::sqrt(2.0) - 0.5, kRounding);
}

TEST(Optimality, CountsTheDistanceFromAMinimum) {
  VectorXd x = FindProblem("HS42").solution;
  x[1] += 0.01;
  EXPECT_GT(At("HS42", x).kkt_error, 1e-3);
}

TEST(Optimality, LetsABoundPushButNeverPull) {
  const VectorXd x = FindProblem("PlaneWithActiveBound").solution;
  const Optimality at = At("PlaneWithActiveBound", x);
  EXPECT_LT(at.kkt_error, kRounding);
  EXPECT_NEAR(at.bound_multipliers[0], 1.75, kRounding);  // -(x1 - 2) - mu, mu = -x3
  // On the same bound where the gradient points inwards nothing may hold it back.
  const auto inward = [](const std::vector<textbook::Dual2>& v) {
    return std::vector<textbook::Dual2>{v[0] + 1};
  };
  textbook::FormulaProblem problem({1, 1, 1, 0}, inward,
                                   [](const auto&) { return std::vector<textbook::Dual2>{}; },
                                   {{0, 0, -5, 0.5}});
  Linearization at_bound(problem.sizes());
  const VectorXd bound = VectorXd::Constant(1, 0.5);
  at_bound.Evaluate(problem, bound);
  EXPECT_NEAR(MeasureOptimality(problem.bounds(), bound, at_bound).kkt_error, 1, kRounding);
}

TEST(Optimality, GivesRedundantRowsTheMultipliersOfLeastNorm) {
  const Optimality at = At("CircleThrice", FindProblem("CircleThrice").solution);
  EXPECT_LT(at.kkt_error, kRounding);
  EXPECT_NEAR(at.multipliers[1], 2 * at.multipliers[0], kRounding);  // parallel rows share the load
}

TEST(Optimality, TellsAMinimumFromAMaximum) {
  const auto problem = FindProblem("CircleThrice").make();  // nearest to (2, 1)
  const VectorXd nearest = FindProblem("CircleThrice").solution;
  for (const double side : {1.0, -1.0}) {
    const VectorXd x = side * nearest;
    Linearization at_x(problem->sizes());
    at_x.Evaluate(*problem, x);
    const Optimality at = MeasureOptimality(problem->bounds(), x, at_x);
    EXPECT_LT(at.kkt_error, kRounding);
    EXPECT_EQ(CurvesUpwards(*problem, x, at_x, at.multipliers), side > 0);
  }
}

// From its far side the circle's stationary point is a maximum, and KINSOL knows equations only.
TEST(Optimality, DoesNotCallAMaximumSolved) {
  const TextbookProblem& known = FindProblem("CircleThrice");
  const Summary summary = Solve(Backend::kKinsol, *known.make(), {}, -1.01 * known.solution);
  VMECH_NEEDS(summary.status != SolveStatus::kUnavailable, summary.message);
  EXPECT_LT(summary.kkt_error, 1e-9);
  EXPECT_EQ(summary.status, SolveStatus::kStalled) << summary.FullReport();
}

}  // namespace
}  // namespace vmech::optimality_test
