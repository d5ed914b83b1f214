#include "vmech/solvers/backends/kinsol.h"

#include <stdexcept>

#include <gtest/gtest.h>

#include "support/needs.h"
#include "textbook_problems.h"

namespace vmech::kinsol_test {
namespace {

using textbook::FindProblem;
using textbook::TextbookProblem;

constexpr double kClosed = 1e-10;  // the stopping rule's

TEST(Kinsol, ClosesAFourBarWhoseCrankIsHeld) {
  const TextbookProblem& known = FindProblem("FourBarPulledOffItsPath");
  const auto problem = known.make();
  KinsolOptions options;
  options.held = {0};
  VectorXd start = known.solution;
  start[0] = 1.3;
  const Summary summary = Solve(*problem, options, start);
  VMECH_NEEDS(summary.status != SolveStatus::kUnavailable, summary.message);
  EXPECT_TRUE(summary.converged()) << summary.FullReport();
  EXPECT_EQ(summary.x[0], 1.3);
  VectorXd c(2);
  problem->Evaluate(summary.x, nullptr, nullptr, &c, nullptr);
  EXPECT_LT(c.norm(), kClosed);
  EXPECT_LT((summary.x - start).norm(), 0.5);  // on the branch of the start
}

// One of four unknowns held and one equation in the others: the rest is a least squares problem.
TEST(Kinsol, MinimisesOverWhatIsNotHeld) {
  const TextbookProblem& known = FindProblem("HS42");
  const auto problem = known.make();
  KinsolOptions options;
  options.held = {1};
  const VectorXd start = Eigen::Vector4d(1, 5, 1, 1);
  const Summary summary = Solve(*problem, options, start);
  VMECH_NEEDS(summary.status != SolveStatus::kUnavailable, summary.message);
  EXPECT_TRUE(summary.converged()) << summary.FullReport();
  VectorXd expected = known.solution;  // x2 stands alone in r and in no constraint
  expected[1] = 5;
  EXPECT_LT((summary.x - expected).norm(), 1e-8);
}

TEST(Kinsol, DoesNotCloseWhatTheHeldCrankKeepsOpen) {
  const TextbookProblem& known = FindProblem("FourBarPulledOffItsPath");
  KinsolOptions options;
  options.held = {0, 1};  // the crank pin and the coupler's end are where they are
  const Summary summary = Solve(*known.make(), options, known.start);
  VMECH_NEEDS(summary.status != SolveStatus::kUnavailable, summary.message);
  EXPECT_FALSE(summary.converged());
  EXPECT_EQ(summary.x.head(2), known.start.head(2));
}

TEST(Kinsol, RefusesToHoldWhatIsNotThere) {
  KinsolOptions options;
  options.held = {3};
  EXPECT_THROW(Solve(*FindProblem("FourBarPulledOffItsPath").make(), options, VectorXd::Zero(3)),
               std::invalid_argument);
}

}  // namespace
}  // namespace vmech::kinsol_test
