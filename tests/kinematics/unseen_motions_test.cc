// Freedoms that neither a hand nor the loops see: rods that spin, an elbow that circles.

#include "vmech/kinematics/loops/unseen_motions.h"

#include <gtest/gtest.h>

#include <cmath>
#include <utility>

#include "support/examples.h"
#include "vmech/kinematics/inverse/assembly_modes.h"
#include "vmech/kinematics/inverse/configuration_distance.h"
#include "vmech/kinematics/loops/dimensionless_loops.h"
#include "vmech/kinematics/tree/forward_kinematics.h"
#include "vmech/solvers/optimality.h"

namespace vmech {
namespace {

constexpr double kBack = 1e-9;

struct Held {
  Held(const std::string& example, const std::string& link)
      : tree(BuildKinematicTree(Example(example))),
        q(StartCoordinates(tree)),
        problem(tree, Frame(link)) {
    EXPECT_TRUE(Assemble(tree, {}, &q).closed);
  }
  GraspFrame Frame(const std::string& link) const {
    const int index = FindLink(tree.mechanism, link);
    return {tree.NodeOfLink(index), tree.X_node_link(index), GraspKind::kRigid};
  }
  int Count() { return FindUnseenMotions(&problem, q).count(); }

  KinematicTree tree;
  VectorXd q;
  InverseKinematics problem;
};

TEST(UnseenMotions, AreTheSpinsOfRodsAndWhatAnArmHasToSpare) {
  EXPECT_EQ(Held("rssr", "rocker").Count(), 1);
  EXPECT_EQ(Held("rssr", "crank").Count(), 1);
  EXPECT_EQ(Held("rssr", "rod").Count(), 0);
  EXPECT_EQ(Held("rsup", "slider").Count(), 0);
  EXPECT_EQ(Held("stewart-gough-sps", "platform").Count(), 6);
  EXPECT_EQ(Held("stewart-gough", "platform").Count(), 0);
  EXPECT_EQ(Held("redundant-arm", "flange").Count(), 1);
  EXPECT_EQ(Held("manseur-doty", "link6").Count(), 0);
  EXPECT_EQ(Held("slider-crank", "slider").Count(), 0);
}

TEST(UnseenMotions, MoveNeitherTheGraspNorTheLoops) {
  for (const auto& [example, link] : {std::pair("rssr", "rocker"),
                                      {"stewart-gough-sps", "platform"},
                                      {"redundant-arm", "flange"}}) {
    Held held(example, link);
    held.problem.SetTarget(held.problem.GraspPose(held.q));
    Linearization at_q(held.problem.sizes());
    at_q.Evaluate(held.problem, held.q);
    const MatrixXd v =
        VelocityScale(held.tree).asDiagonal() * FindUnseenMotions(&held.problem, held.q).basis;
    EXPECT_LT((at_q.J * v).norm() + (at_q.C * v).norm(), 1e-10) << example;
  }
}

TEST(UnseenMotions, DoNotCountWhatADeadCentreHides) {
  Held held("slider-crank", "slider");
  AssemblyOptions options;
  const int crank = FindJoint(held.tree.mechanism, "main");
  held.q[CoordinateIndex(held.tree, crank, 0)] = 0;  // crank and rod in line
  options.fixed = {VelocityIndex(held.tree, crank, 0)};
  ASSERT_TRUE(Assemble(held.tree, options, &held.q).closed);
  EXPECT_EQ(held.Count(), 0);
}

TEST(NearestAlongUnseen, TurnsSpinningRodsBack) {
  for (const auto& [example, link] :
       {std::pair("rssr", "rocker"), {"rssr", "crank"}, {"stewart-gough-sps", "platform"}}) {
    Held held(example, link);
    const MatrixXd spins = FindUnseenMotions(&held.problem, held.q).basis;
    for (const double angle : {0.1, 1.0, 2.5}) {
      VectorXd spun = held.q;
      MoveCoordinates(held.tree, spins * VectorXd::Constant(spins.cols(), angle), &spun);
      ASSERT_TRUE(Assemble(held.tree, {}, &spun).closed);
      ASSERT_GT(ConfigurationDistance(held.tree, spun, held.q), 0.9 * angle);
      const VectorXd back = NearestAlongUnseen(&held.problem, spun, held.q);
      EXPECT_LT(ConfigurationDistance(held.tree, back, held.q), kBack) << example << angle;
    }
  }
}

TEST(NearestAlongUnseen, LeadsAnElbowRoundItsCircle) {
  // From the elbow on one side to that on the other, by a way that first leads away from it.
  Held held("redundant-arm", "flange");
  const Posed X_WG = held.problem.GraspPose(held.q);
  VectorXd circled = held.q;
  for (int i = 0; i < 25; ++i) {
    const VectorXd n = FindUnseenMotions(&held.problem, circled).basis.col(0);
    VectorXd ahead = circled;
    MoveCoordinates(held.tree, 0.1 * n * (n[2] > 0 ? 1 : -1), &ahead);
    circled = NearestAlongUnseen(&held.problem, circled, ahead, 1);
  }
  EXPECT_LT((held.problem.GraspPose(circled).p - X_WG.p).norm(), 1e-9);
  ASSERT_GT(ConfigurationDistance(held.tree, circled, held.q), 0.5);
  const VectorXd back = NearestAlongUnseen(&held.problem, circled, held.q);
  EXPECT_LT(ConfigurationDistance(held.tree, back, held.q), 1e-6);
}

TEST(NearestAlongUnseen, DoesNotLeadToTheOtherBranch) {
  // The two cranks of one rocker.
  Held held("rssr", "rocker");
  AssemblyModesOptions options;
  options.hand = HandPose{held.problem.grasp(), held.problem.GraspPose(held.q)};
  options.links = {FindLink(held.tree.mechanism, "crank")};
  options.patience = 200;
  const AssemblyModes modes = FindAssemblyModes(held.tree, options, held.q);
  ASSERT_EQ(modes.modes.size(), 2U);
  const VectorXd nearest = NearestAlongUnseen(&held.problem, modes.modes[1].q, held.q);
  EXPECT_GT(ConfigurationDistance(held.tree, nearest, held.q), 0.1);
  const VectorXd own = NearestAlongUnseen(&held.problem, modes.modes[0].q, held.q);
  EXPECT_LT(ConfigurationDistance(held.tree, own, held.q), kBack);
}

TEST(NearestAlongUnseen, LeavesTheHandsTargetAsItWas) {
  Held held("rssr", "rocker");
  const Posed X_WH{Matrix3d::Identity(), Vector3d(1, 2, 3)};
  held.problem.SetTarget(X_WH);
  (void)NearestAlongUnseen(&held.problem, held.q, held.q);
  EXPECT_EQ(held.problem.target().p, X_WH.p);
}

TEST(ConfigurationDistance, IsReachedByTheDifferenceInAUnitOfTime) {
  for (const char* example : {"rssr", "stewart-gough-sps", "slider-crank"}) {
    const KinematicTree tree = BuildKinematicTree(Example(example));
    Random random(5);
    const VectorXd a = RandomCoordinates(tree, &random, 1), b = RandomCoordinates(tree, &random, 1);
    const VectorXd difference = ConfigurationDifference(tree, a, b);
    VectorXd there = a;
    MoveCoordinates(tree, VelocityScale(tree).cwiseProduct(difference), &there);
    EXPECT_LT(ConfigurationDistance(tree, there, b), kBack);
    EXPECT_NEAR(difference.norm(), ConfigurationDistance(tree, b, a), kBack);
  }
}

}  // namespace
}  // namespace vmech
