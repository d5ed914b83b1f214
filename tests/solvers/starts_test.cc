#include "vmech/solvers/starts.h"

#include <gtest/gtest.h>

#include <set>

#include "textbook_problems.h"
#include "vmech/solvers/nullspace.h"

namespace vmech::starts_test {
namespace {

using textbook::Dual2;
using textbook::FindProblem;
using textbook::FormulaProblem;
using V = std::vector<Dual2>;

// x^2 + y^2 = 5 and x y = 2: at (1, 2), (2, 1) and their opposites.
FormulaProblem FourCrossings(std::vector<Bound> bounds = {}) {
  return {{2, 2, 0, 2},
          [](const V&) { return V{}; },
          [](const V& x) {
            return V{x[0] * x[0] + x[1] * x[1] - 5, x[0] * x[1] - 2};
          },
          std::move(bounds)};
}

std::set<std::pair<int, int>> CrossingsFrom(FormulaProblem& problem,
                                            const std::vector<VectorXd>& starts) {
  std::set<std::pair<int, int>> found;
  for (const VectorXd& start : starts) {
    const Summary summary = Solve(problem, NullspaceOptions{}, start);
    if (!summary.converged()) continue;
    found.insert(
        {static_cast<int>(std::lround(summary.x[0])), static_cast<int>(std::lround(summary.x[1]))});
  }
  return found;
}

TEST(Starts, LeadToEverySolution) {
  FormulaProblem problem = FourCrossings();
  const auto starts = FindStarts(problem, VectorXd::Ones(2));
  EXPECT_EQ(CrossingsFrom(problem, starts),
            (std::set<std::pair<int, int>>{{-2, -1}, {-1, -2}, {1, 2}, {2, 1}}));
}

TEST(Starts, StayWithinBounds) {
  FormulaProblem problem = FourCrossings({{0, 0, 0.5, 9}, {1, 1, -3, 8}});
  const auto starts = FindStarts(problem, VectorXd::Ones(2));
  for (const VectorXd& x : starts) {
    EXPECT_GE(x[0], 0.5);
    EXPECT_LE(x[0], 9);
    EXPECT_GE(x[1], -3);
    EXPECT_LE(x[1], 8);
  }
  EXPECT_EQ(CrossingsFrom(problem, starts), (std::set<std::pair<int, int>>{{1, 2}, {2, 1}}));
}

TEST(Starts, ComeBestFirstAndApart) {
  FormulaProblem problem = FourCrossings();
  StartsOptions options;
  options.steps = 0;  // the points themselves
  const auto starts = FindStarts(problem, VectorXd::Ones(2), options);
  ASSERT_EQ(starts.size(), 10u);
  double last = 0;
  for (size_t i = 0; i < starts.size(); ++i) {
    VectorXd c(2);
    problem.Evaluate(starts[i], nullptr, nullptr, &c, nullptr);
    EXPECT_GE(c.norm(), last);
    last = c.norm();
    for (size_t j = 0; j < i; ++j) {
      EXPECT_GE((starts[i] - starts[j]).cwiseAbs().maxCoeff(), options.separation);
    }
  }
}

// The four-bar's middle, pulled from the branch of the other closure.
TEST(Starts, FindTheWayToTheOtherBranch) {
  const textbook::TextbookProblem& known = FindProblem("FourBarPulledOffItsPath");
  const auto problem = known.make();
  const VectorXd far = known.solution + Eigen::Vector3d(2.5, -2, 2);
  double best = 1e9;
  for (const VectorXd& start : FindStarts(*problem, far)) {
    const Summary summary = Solve(*problem, NullspaceOptions{}, start);
    if (summary.converged()) best = std::min(best, summary.objective);
  }
  EXPECT_NEAR(best, known.objective, 1e-9);
}

TEST(Starts, KeepUnitQuaternionsOfLengthOne) {
  const auto problem = FindProblem("QuaternionOnACone").make();
  for (const VectorXd& x : FindStarts(*problem, FindProblem("QuaternionOnACone").start)) {
    EXPECT_NEAR(x.head(4).norm(), 1, 1e-12);
  }
}

}  // namespace
}  // namespace vmech::starts_test
