#include "vmech/comparison/statistics.h"

#include <gtest/gtest.h>

#include <cmath>

namespace vmech {
namespace {

Suite TwoBlocks() {
  Suite suite;
  suite.blocks.resize(2);
  suite.blocks[1].kind = TargetKind::kUnreachable;
  return suite;
}

Result Of(int block, int index, Backend solver, Verdict verdict, double time = 1) {
  Result result;
  result.problem = {0, block, index};
  result.solver = SolverEntry(solver);
  result.verdict = verdict;
  result.time = time;
  return result;
}

bool All(const Result&) {
  return true;
}

TEST(TallyOf, TakesForSuccessWhatTheKindOfTargetAsksFor) {
  const std::vector<Result> results = {
      Of(0, 0, Backend::kPenalty, Verdict::kSolved),
      Of(0, 1, Backend::kPenalty, Verdict::kUnreachable),
      Of(1, 0, Backend::kPenalty, Verdict::kUnreachable),
      Of(1, 1, Backend::kPenalty, Verdict::kBiased),
  };
  const Tally tally = TallyOf(TwoBlocks(), results, All);
  EXPECT_EQ(tally.problems, 4);
  EXPECT_EQ(tally.succeeded, 2);
  EXPECT_EQ(tally.share(), 0.5);
}

TEST(TallyOf, LeavesOutWhatCannotBeHeldAgainstASolver) {
  const std::vector<Result> results = {
      Of(0, 0, Backend::kPenalty, Verdict::kNotPosed),
      Of(0, 1, Backend::kPenalty, Verdict::kUnavailable),
      Of(0, 2, Backend::kPenalty, Verdict::kUnsuitable),
  };
  EXPECT_EQ(TallyOf(TwoBlocks(), results, All).problems, 1);
}

TEST(CostsOf, HasARowPerProblemAndInfinityForFailures) {
  const std::vector<Result> results = {
      Of(0, 0, Backend::kPenalty, Verdict::kSolved, 3),
      Of(0, 0, Backend::kNullspace, Verdict::kStalled, 1),
      Of(1, 0, Backend::kPenalty, Verdict::kSolved, 2),  // where it cannot be reached: a failure
      Of(1, 0, Backend::kNullspace, Verdict::kUnreachable, 5),
  };
  const auto costs = CostsOf(TwoBlocks(), results, SolversOf(results), All,
                             [](const Result& result) { return result.time; });
  ASSERT_EQ(costs.size(), 2u);
  EXPECT_EQ(costs[0][0], 3);
  EXPECT_TRUE(std::isinf(costs[0][1]));
  EXPECT_TRUE(std::isinf(costs[1][0]));
  EXPECT_EQ(costs[1][1], 5);
}

TEST(MedianOf, IsTheMiddleOrTheMeanOfTheTwoThere) {
  EXPECT_EQ(MedianOf({3, 1, 2}), 2);
  EXPECT_EQ(MedianOf({4, 1, 2, 3}), 2.5);
  EXPECT_TRUE(std::isnan(MedianOf({})));
}

}  // namespace
}  // namespace vmech
