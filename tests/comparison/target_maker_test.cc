#include "vmech/comparison/target_maker.h"

#include <gtest/gtest.h>

#include "support/examples.h"
#include "vmech/comparison/closed_walk.h"
#include "vmech/kinematics/inverse/configuration_distance.h"
#include "vmech/kinematics/loops/closure.h"
#include "vmech/solvers/optimality.h"

namespace vmech {
namespace {

constexpr double kClosed = 1e-12;      // Assemble closes loops to 1e-13
constexpr double kStationary = 1e-11;  // rounding of J'r at |r| = 0.1, of loops known to 1e-13
constexpr int kSeeds = 10;

SuiteMechanism Entry(const std::string& example) {
  SuiteMechanism entry;
  entry.name = example;
  entry.mechanism = Example(example);
  entry.grasp = entry.mechanism.grasps.at(0);
  return entry;
}

/// A link that stands still where it turns back.
SuiteMechanism HeldBySlider() {
  SuiteMechanism entry = Entry("slider-crank");
  entry.grasp = {"slider", FindLink(entry.mechanism, "slider"), {}, GraspKind::kPoint};
  return entry;
}

double LoopErrorAt(const KinematicTree& tree, const VectorXd& q) {
  TreeWorkspace<double> ws(tree);
  EvaluatePose(tree, q, &ws);
  return LargestLoopError(tree, ws);
}

class EveryKind : public testing::TestWithParam<const char*> {};

TEST_P(EveryKind, BeginsAtAClosedConfigurationAndAimsAtOne) {
  Subject subject(Entry(GetParam()));
  TargetBlock block;
  block.steps = 10;
  for (const TargetKind kind :
       {TargetKind::kReachable, TargetKind::kUnreachable, TargetKind::kSingular,
        TargetKind::kDeadCentre, TargetKind::kTracking}) {
    block.kind = kind;
    for (uint64_t seed = 0; seed < 3; ++seed) {
      const Problem problem = MakeProblem(&subject, block, seed);
      if (!problem.defect.empty()) continue;
      EXPECT_EQ(problem.targets.size(), block.is_path() ? 10u : 1u);
      EXPECT_LT(LoopErrorAt(subject.tree(), problem.start), kClosed);
      for (const VectorXd& q : problem.own) EXPECT_LT(LoopErrorAt(subject.tree(), q), kClosed);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Examples, EveryKind,
                         testing::Values("slider-crank", "rssr", "bricard", "stewart-gough",
                                         "delta-robot", "two-link-arm"),
                         [](const auto& info) { return TestName(info.param); });

TEST(MakeProblem, GivesTheSameProblemForTheSameSeedAndOthersForOthers) {
  Subject subject(Entry("rssr"));
  const TargetBlock block;
  const Problem a = MakeProblem(&subject, block, 7), b = MakeProblem(&subject, block, 7);
  EXPECT_EQ(a.own[0], b.own[0]);
  EXPECT_EQ(a.start, b.start);
  EXPECT_NE(a.own[0], MakeProblem(&subject, block, 8).own[0]);
}

TEST(MakeProblem, StartsNearWhereItIsAskedTo) {
  Subject subject(Entry("stewart-gough"));
  TargetBlock block;
  block.start_distance = 0.05;
  for (uint64_t seed = 0; seed < kSeeds; ++seed) {
    const Problem problem = MakeProblem(&subject, block, seed);
    const double distance = ConfigurationDistance(subject.tree(), problem.start, problem.own[0]);
    EXPECT_GT(distance, 0.3 * block.start_distance);
    EXPECT_LT(distance, 2 * block.start_distance);
  }
}

TEST(MakeProblem, PutsAnUnreachableTargetOffAStationaryPose) {
  for (const char* name : {"slider-crank", "rssr", "bennett", "delta-robot"}) {
    Subject subject(Entry(name));
    TargetBlock block;
    block.kind = TargetKind::kUnreachable;
    block.offset = 0.1;
    for (uint64_t seed = 0; seed < kSeeds; ++seed) {
      const Problem problem = MakeProblem(&subject, block, seed);
      ASSERT_EQ(problem.defect, "") << name;
      InverseKinematics& ik = subject.problem();
      ik.SetTarget(problem.targets[0]);
      Linearization at_q(ik.sizes());
      at_q.Evaluate(ik, problem.own[0]);
      const Optimality optimality = MeasureOptimality({}, problem.own[0], at_q);
      EXPECT_NEAR(at_q.r.norm(), block.offset, kStationary) << name;
      EXPECT_LT(optimality.kkt_error, kStationary) << name;
    }
  }
}

TEST(MakeProblem, FindsNoUnreachableTargetForAFreePlatform) {
  Subject subject(Entry("stewart-gough"));
  TargetBlock block;
  block.kind = TargetKind::kUnreachable;
  EXPECT_NE(MakeProblem(&subject, block, 1).defect, "");
}

TEST(MakeProblem, ComesAsCloseToASingularPoseAsAsked) {
  Subject subject(HeldBySlider());
  TargetBlock block;
  block.kind = TargetKind::kSingular;
  block.closeness = 1e-3;
  for (uint64_t seed = 0; seed < kSeeds; ++seed) {
    const Problem problem = MakeProblem(&subject, block, seed);
    ASSERT_EQ(problem.defect, "");
    EXPECT_LE(subject.Determination(problem.own[0]), block.closeness);
    // Crank and rod of a slider-crank lie in one line where the slider turns back.
    const int main = CoordinateIndex(subject.tree(), 0, 0);
    EXPECT_LT(std::abs(std::sin(problem.own[0][main])), 10 * block.closeness);
  }
}

TEST(MakeProblem, PutsADeadCentreIntoTheMiddleOfItsPath) {
  Subject subject(HeldBySlider());
  TargetBlock block;
  block.kind = TargetKind::kDeadCentre;
  block.steps = 20;
  for (uint64_t seed = 0; seed < kSeeds; ++seed) {
    const Problem problem = MakeProblem(&subject, block, seed);
    ASSERT_EQ(problem.targets.size(), 20u) << problem.defect;
    int turns = 0;
    for (size_t k = 1; k + 1 < problem.own.size(); ++k) {
      const VectorXd before = problem.own[k] - problem.own[k - 1];
      const VectorXd after = problem.own[k + 1] - problem.own[k];
      const bool turning = (before.array() * after.array() < 0).any();
      turns += turning ? 1 : 0;
      if (turning) {
        EXPECT_NEAR(static_cast<double>(k), 10, 2);
      }
    }
    EXPECT_EQ(turns, 1);
  }
}

TEST(PortableRandom, GivesTheNumbersOfSplitMix64) {
  PortableRandom random(1234567);  // first outputs of the authors' reference implementation
  EXPECT_EQ(random.Next(), 6457827717110365317u);
  EXPECT_EQ(random.Next(), 3203168211198807973u);
  EXPECT_EQ(random.Next(), 9817491932198370423u);
}

}  // namespace
}  // namespace vmech
