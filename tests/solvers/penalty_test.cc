#include "vmech/solvers/penalty.h"

#include <gtest/gtest.h>

#include <Eigen/QR>
#include <limits>
#include <stdexcept>

#include "textbook_problems.h"
#include "vmech/solvers/augmented_lagrangian.h"
#include "vmech/solvers/nullspace.h"

namespace vmech::penalty_test {
namespace {

using textbook::FindProblem;
using textbook::TextbookProblem;

Summary SolvedWithWeight(double lambda) {
  const TextbookProblem& known = FindProblem("FourBarPulledOffItsPath");
  PenaltyOptions options;
  options.weight = lambda;
  return Solve(*known.make(), options, known.start);
}

TEST(Penalty, LeavesTheConstraintsOpenByOneOverLambdaSquared) {
  const double at_30 = SolvedWithWeight(30).constraint_norm;
  const double at_300 = SolvedWithWeight(300).constraint_norm;
  EXPECT_NEAR(at_30 / at_300, 100, 1);  // the next order is 1 / lambda^4
}

TEST(Penalty, ReportsABoundThatHoldsAndIsTight) {
  const TextbookProblem& known = FindProblem("FourBarPulledOffItsPath");
  const auto problem = known.make();
  const Summary exact = Solve(*problem, NullspaceOptions{}, known.start);
  for (double lambda : {10.0, 100.0, 1000.0}) {
    const Summary biased = SolvedWithWeight(lambda);
    VectorXd c(2);
    problem->Evaluate(biased.x, nullptr, nullptr, &c, nullptr);
    EXPECT_EQ(biased.status, SolveStatus::kBiased);
    EXPECT_LE(c.norm(), biased.bias_bound * (1 + 1e-9)) << "lambda " << lambda;
    const double expected = exact.multipliers.norm() / (lambda * lambda);
    EXPECT_NEAR(biased.bias_bound / expected, 1, 5 / lambda) << "lambda " << lambda;
  }
}

TEST(Penalty, StepSolvesTheStackedLeastSquaresOfTheEquation) {
  const TextbookProblem& known = FindProblem("HS42");
  const auto problem = known.make();
  const PenaltyOptions options;
  PenaltyWorkspace workspace(*problem);
  Linearization at_x(problem->sizes());
  at_x.Evaluate(*problem, known.start);
  MatrixXd A(6, 4);
  A << at_x.J, options.weight * at_x.C;
  VectorXd b(6);
  b << at_x.r, options.weight * at_x.c;
  const VectorXd expected = known.start - A.colPivHouseholderQr().solve(b);
  VectorXd x = known.start;
  ASSERT_TRUE(Step(*problem, options, &x, &workspace).ok);
  EXPECT_LT((x - expected).norm(), 1e-5);  // the damping, 1e-12 of lambda^2 = 1e6, acts on J'J = 1
}

TEST(AugmentedLagrangian, StepsCloseTheConstraintsThatThePenaltyLeavesOpen) {
  const TextbookProblem& known = FindProblem("FourBarPulledOffItsPath");
  const auto problem = known.make();
  AugmentedLagrangianOptions options;
  options.weight = 100;
  AugmentedLagrangianWorkspace workspace(*problem);
  VectorXd x = known.start;
  for (int tick = 0; tick < 30; ++tick) {
    ASSERT_TRUE(Step(*problem, options, &x, &workspace).ok);
  }
  EXPECT_LT((x - known.solution).norm(), 1e-9);
  const Summary exact = Solve(*problem, NullspaceOptions{}, known.start);
  EXPECT_LT((workspace.multipliers - exact.multipliers).norm(), 1e-8);
}

TEST(Penalty, StepRefusesValuesThatAreNotFinite) {
  const auto problem = FindProblem("HS6").make();
  PenaltyWorkspace workspace(*problem);
  VectorXd x = VectorXd::Constant(2, std::numeric_limits<double>::quiet_NaN());
  EXPECT_FALSE(Step(*problem, PenaltyOptions{}, &x, &workspace).ok);
}

/// The point of the unit circle at (0.6, 0.8); where no derivatives are asked for, not a number.
class ValuesOnlyAreUndefined final : public ConstrainedLeastSquares {
 public:
  ValuesOnlyAreUndefined() : ConstrainedLeastSquares({2, 2, 2, 1}) {}
  void Evaluate(const VectorXd& x, VectorXd* r, MatrixXd* J, VectorXd* c, MatrixXd* C) override {
    values_only += J == nullptr;
    const double undefined = J ? 0 : std::numeric_limits<double>::quiet_NaN();
    if (r) *r << x[0] - 0.6 + undefined, x[1] - 0.8;
    if (J) J->setIdentity();
    if (c) *c << x.squaredNorm() - 1;
    if (C) *C = 2 * x.transpose();
  }
  int values_only = 0;
};

TEST(Penalty, TakesNoLastStepToWhereItIsNotDefined) {
  ValuesOnlyAreUndefined problem;
  PenaltyWorkspace workspace(problem);
  VectorXd x = Eigen::Vector2d(0.7, 1);
  EXPECT_EQ(Solve(problem, PenaltyOptions{}, &x, &workspace).claim, SolveStatus::kBiased);
  EXPECT_GT(problem.values_only, 0);  // it was tried
  EXPECT_LT((x - Eigen::Vector2d(0.6, 0.8)).norm(), 1e-9);
}

TEST(Penalty, RefusesOptionsOutOfRangeByName) {
  PenaltyOptions options;
  options.weight = 0;
  try {
    options.Validate();
    FAIL() << "a weight of zero was accepted";
  } catch (const std::invalid_argument& error) {
    EXPECT_STREQ(error.what(), "PenaltyOptions.weight = 0, must be in [1, 1000000]");
  }
}

}  // namespace
}  // namespace vmech::penalty_test
