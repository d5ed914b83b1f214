#include "vmech/comparison/solve_problem.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <utility>

#include "support/examples.h"

namespace vmech {
namespace {

/// A suite of one mechanism and one block.
struct OneBlock {
  explicit OneBlock(const std::string& example, TargetBlock block = {}, int grasp = 0) {
    SuiteMechanism entry;
    entry.name = example;
    entry.mechanism = Example(example);
    entry.grasp = entry.mechanism.grasps.at(grasp);
    entry.blocks = {0};
    suite.mechanisms = {entry};
    suite.blocks = {std::move(block)};
    suite.stopping.optimality_tolerance = 1e-8;
    suite.repetitions = 1;
  }
  Result Solve(uint64_t seed, Backend backend = Backend::kNullspace) {
    return Solve(seed, SolverEntry(backend));
  }
  Result Solve(uint64_t seed, SolverEntry solver) {
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
  const Result result = one.Solve(3, SolverEntry::FastPath());
  EXPECT_EQ(result.verdict, Verdict::kSolved) << result.message;
  EXPECT_EQ(result.reached, 20);
  EXPECT_LE(result.e2, one.suite.stopping.constraint_tolerance);
  EXPECT_GT(result.time, 0);
}

/// Mechanisms with freedoms that neither the grasp nor the loops see, by their grasps.
constexpr std::pair<const char*, int> kUnseen[] = {
    {"rssr", 1}, {"rssr", 2}, {"stewart-gough-sps", 0}, {"redundant-arm", 0}};

TEST(SolveProblem, ReachesTargetsThatLeaveFreedomsUnseenByEveryExactMethod) {
  TargetBlock block;
  block.start_distance = 0.2;
  for (const auto& [example, grasp] : kUnseen) {
    OneBlock one(example, block, grasp);
    for (const Backend backend : {Backend::kPenalty, Backend::kAugmentedLagrangian,
                                  Backend::kNullspace, Backend::kCeresExact, Backend::kIpopt}) {
      for (uint64_t seed = 0; seed < 5; ++seed) {
        const Result result = one.Solve(seed, backend);
        if (result.verdict == Verdict::kUnavailable) continue;
        EXPECT_EQ(result.verdict, Verdict::kSolved)
            << example << " by " << NameOf(backend) << ", seed " << seed << ": " << result.message;
      }
    }
  }
}

TEST(SolveProblem, FollowsPathsThatLeaveFreedomsUnseen) {
  for (const auto& [example, grasp] : kUnseen) {
    OneBlock one(example, Block(TargetKind::kTracking), grasp);
    for (uint64_t seed = 0; seed < 4; ++seed) {
      for (const SolverEntry& solver :
           {SolverEntry::FastPath(), SolverEntry(Backend::kAugmentedLagrangian)}) {
        const Result result = one.Solve(seed, solver);
        EXPECT_EQ(result.verdict, Verdict::kSolved)
            << example << " by " << solver.name() << ": " << result.message;
        EXPECT_NE(result.branch, Branch::kFree);
      }
    }
  }
}

TEST(SolveProblem, TellsTheBranchWhateverWayARodHasSpun) {
  // A rocker has two cranks: which one is found is told from the crank alone.
  OneBlock one("rssr", {}, 1);
  Subject subject(one.suite.mechanisms[0]);
  const KinematicTree& tree = subject.tree();
  const int crank = CoordinateIndex(tree, FindJoint(tree.mechanism, "input"), 0);
  InverseKinematics& ik = subject.problem();
  int own = 0, other = 0;
  for (uint64_t seed = 0; seed < 20; ++seed) {
    TargetBlock block;
    block.start = seed < 10 ? StartKind::kNear : StartKind::kFar;
    const Problem problem = MakeProblem(&subject, block, seed);
    EXPECT_TRUE(problem.determined);
    ik.SetTarget(problem.targets[0]);
    const Summary summary = Solve(Backend::kNullspace, ik, {}, problem.start);
    const Result result =
        SolveProblem(one.suite, {}, problem, &subject, SolverEntry(Backend::kNullspace));
    if (result.verdict != Verdict::kSolved) continue;
    const double off =
        std::abs(std::remainder(summary.x[crank] - problem.own[0][crank], 2 * std::numbers::pi));
    EXPECT_EQ(result.branch, off < 1e-4 ? Branch::kOwn : Branch::kOther) << "seed " << seed;
    ++(off < 1e-4 ? own : other);
  }
  EXPECT_GT(own, 0);
  EXPECT_GT(other, 0);
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
