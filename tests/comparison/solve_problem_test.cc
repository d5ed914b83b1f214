#include "vmech/comparison/solve_problem.h"

#include <gtest/gtest.h>

#include "support/examples.h"

namespace vmech {
namespace {

/// A suite of one mechanism and one block.
struct OneBlock {
  explicit OneBlock(const std::string& example, TargetBlock block = {}) {
    SuiteMechanism entry;
    entry.name = example;
    entry.mechanism = Example(example);
    entry.grasp = entry.mechanism.grasps.at(0);
    entry.blocks = {0};
    suite.mechanisms = {entry};
    suite.blocks = {std::move(block)};
    suite.stopping.optimality_tolerance = 1e-8;
    suite.repetitions = 1;
  }
  Result Solve(uint64_t seed, Backend backend = Backend::kNullspace) {
    return Solve(seed, Contestant(backend));
  }
  Result Solve(uint64_t seed, Contestant solver) {
    Subject subject(suite.mechanisms[0]);
    const Problem problem = MakeProblem(&subject, suite.blocks[0], seed);
    return SolveProblem(suite, {}, problem, &subject, solver);
  }
  Suite suite;
};

TargetBlock Block(TargetKind kind) {
  TargetBlock block;
  block.kind = kind;
  block.steps = 20;
  return block;
}

TEST(SolveProblem, ReachesATargetOnItsOwnBranchFromNearby) {
  OneBlock one("rssr");
  const Result result = one.Solve(1);
  EXPECT_EQ(result.verdict, Verdict::kSolved) << result.message;
  EXPECT_EQ(result.branch, Branch::kOwn);
  EXPECT_EQ(result.reached, 1);
  EXPECT_LE(result.e2, one.suite.stopping.constraint_tolerance);
  EXPECT_GT(result.evaluations, 0);
  EXPECT_TRUE(Succeeded(result, TargetKind::kReachable));
}

TEST(SolveProblem, ReachesEveryTargetOfARedundantLoopFromNearby) {
  TargetBlock block;
  block.start_distance = 0.2;
  OneBlock one("bricard", block);
  for (uint64_t seed = 0; seed < 150; ++seed) {
    const Result result = one.Solve(seed);
    EXPECT_EQ(result.verdict, Verdict::kSolved) << "seed " << seed << ": " << result.message;
  }
}

TEST(SolveProblem, CallsAConstrainedMinimumOffAnUnreachableTargetUnreachable) {
  OneBlock one("slider-crank", Block(TargetKind::kUnreachable));
  const Result result = one.Solve(2);
  EXPECT_EQ(result.verdict, Verdict::kUnreachable) << result.message;
  EXPECT_EQ(result.reached, 0);
  EXPECT_LE(result.kkt, one.suite.stopping.optimality_tolerance);
  EXPECT_TRUE(Succeeded(result, TargetKind::kUnreachable));
}

TEST(SolveProblem, ShowsTheBiasOfThePenalty) {
  OneBlock one("slider-crank", Block(TargetKind::kUnreachable));
  const Result result = one.Solve(2, Backend::kPenalty);
  EXPECT_EQ(result.verdict, Verdict::kBiased) << result.message;
  EXPECT_GT(result.e2, one.suite.stopping.constraint_tolerance);
  EXPECT_FALSE(Succeeded(result, TargetKind::kUnreachable));
}

TEST(SolveProblem, FollowsAPathThroughADeadCentre) {
  for (const TargetKind kind : {TargetKind::kTracking, TargetKind::kDeadCentre}) {
    OneBlock one("four-bar", Block(kind));
    const Result result = one.Solve(3, Backend::kAugmentedLagrangian);
    EXPECT_EQ(result.verdict, Verdict::kSolved) << result.message;
    EXPECT_EQ(result.reached, 20);
    EXPECT_EQ(result.jumps, 0);
    EXPECT_EQ(result.branch, Branch::kOwn);
  }
}

TEST(SolveProblem, FollowsAPathByTheFastPath) {
  OneBlock one("stewart-gough", Block(TargetKind::kTracking));
  const Result result = one.Solve(3, Contestant::FastPath());
  EXPECT_EQ(result.verdict, Verdict::kSolved) << result.message;
  EXPECT_EQ(result.reached, 20);
  EXPECT_LE(result.e2, one.suite.stopping.constraint_tolerance);
  EXPECT_GT(result.time, 0);
}

TEST(SolveProblem, CountsTheTargetsThatAreLostWhereIterationsAreTooFew) {
  OneBlock one("four-bar", Block(TargetKind::kTracking));
  one.suite.stopping.max_iterations = 1;
  const Result result = one.Solve(3);
  EXPECT_EQ(result.verdict, Verdict::kLost);
  EXPECT_LT(result.reached, result.targets);
  EXPECT_NE(result.message.find("first at target 1: iteration limit"), std::string::npos)
      << result.message;
}

TEST(SolveProblem, SaysWhyThereIsNoProblem) {
  OneBlock one("stewart-gough", Block(TargetKind::kDeadCentre));
  const Result result = one.Solve(1);
  EXPECT_EQ(result.verdict, Verdict::kNotPosed);
  EXPECT_NE(result.message, "");
  EXPECT_FALSE(Counts(result));
}

}  // namespace
}  // namespace vmech
