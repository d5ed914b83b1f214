#include "vmech/kinematics/loops/loop_clusters.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "support/examples.h"
#include "vmech/kinematics/loops/closure.h"
#include "vmech/kinematics/loops/mobility.h"

namespace vmech {
namespace {

/// A rocker on two parallelograms, one on the coupler of the other, whose second stands at an angle
/// and is opened by `gap`; and a door on two hinges on top.
const char* const kTower = R"(vmech: "1.0"
units: {length: m, angle: deg}
gravity: [0, -9.81, 0]
ground: base
links:
  base:   {anchors: {r: {origin: [9, 0, 0], z: [1, 0, 0], x: [0, 1, 0]}}}
  rocker: {anchors: {r: {origin: [9, 0, 0], z: [1, 0, 0], x: [0, 1, 0]},
                     a: {origin: [0, 0, 0], z: [0, 0, 1], x: [1, 0, 0]},
                     b: {origin: [5, 0, 0], z: [0, 0, 1], x: [1, 0, 0]}}}
  p0:     {anchors: {low: {origin: [0, 0, 0], z: [0, 0, 1], x: [1, 0, 0]},
                     up: {origin: [3, 0, 0], z: [0, 0, 1], x: [1, 0, 0]}}}
  q0:     {anchors: {low: {origin: [0, 0, 0], z: [0, 0, 1], x: [1, 0, 0]},
                     up: {origin: [3, 0, 0], z: [0, 0, 1], x: [1, 0, 0]}}}
  floor0: {anchors: {c: {origin: [0, 0, 0], z: [0, 0, 1], x: [1, 0, 0]},
                     d: {origin: [5, 0, 0], z: [0, 0, 1], x: [1, 0, 0]},
                     a: {origin: [0, 1, 0], z: [0, 1, 0], x: [1, 0, 0]},
                     b: {origin: [5, 1, 0], z: [0, 1, 0], x: [1, 0, 0]}}}
  p1:     {anchors: {low: {origin: [0, 0, 0], z: [0, 1, 0], x: [1, 0, 0]},
                     up: {origin: [3, 0, 0], z: [0, 1, 0], x: [1, 0, 0]}}}
  q1:     {anchors: {low: {origin: [0, 0, 0], z: [0, 1, 0], x: [1, 0, 0]},
                     up: {origin: [3, 0, 0], z: [0, 1, 0], x: [1, 0, 0]}}}
  floor1: {anchors: {c: {origin: [0, 0, 0], z: [0, 1, 0], x: [1, 0, 0]},
                     d: {origin: [5, 0, 0], z: [0, 1, 0], x: [1, 0, 0]},
                     up: {origin: [0, 0, 9], z: [0, 0, 1], x: [1, 0, 0]},
                     low: {origin: [0, 0, 0], z: [0, 0, 1], x: [1, 0, 0]}}}
  door:   {anchors: {up: {origin: [0, 0, 9], z: [0, 0, 1], x: [1, 0, 0]},
                     low: {origin: [0, 0, 0], z: [0, 0, 1], x: [1, 0, 0]}}}
joints:
  rocker: {type: revolute, connects: [base/r, rocker/r], start: 20}
  a0: {type: revolute, connects: [rocker/a, p0/low], start: 70}
  b0: {type: revolute, connects: [rocker/b, q0/low], start: 70}
  c0: {type: revolute, connects: [p0/up, floor0/c], start: -70}
  d0: {type: revolute, connects: [q0/up, floor0/d], start: -70}
  a1: {type: revolute, connects: [floor0/a, p1/low], start: 40}
  b1: {type: revolute, connects: [floor0/b, q1/low], start: 43}
  c1: {type: revolute, connects: [p1/up, floor1/c], start: -38}
  d1: {type: revolute, connects: [q1/up, floor1/d], start: -40}
  up:  {type: revolute, connects: [floor1/up, door/up], start: 5}
  low: {type: revolute, connects: [floor1/low, door/low], start: 5}
)";

KinematicTree Tower() {
  return BuildKinematicTree(ParseMechanism(kTower, "tower.yaml"));
}

std::vector<KinematicTree> AllTrees() {
  std::vector<KinematicTree> trees{Tower()};
  for (const std::string& name : ExampleNames()) {
    trees.push_back(BuildKinematicTree(Example(name)));
  }
  return trees;
}

/// Errors and Jacobian of all loops at q.
std::pair<VectorXd, MatrixXd> EquationsAt(const KinematicTree& tree, const VectorXd& q) {
  TreeWorkspace<double> ws(tree);
  EvaluatePose(tree, q, &ws);
  return {StackedLoopErrors(tree, ws), DenseLoopJacobian(tree, ws)};
}

TEST(LoopClusters, HaveNoVelocityInCommon) {
  for (const KinematicTree& tree : AllTrees()) {
    std::vector<int> uses(tree.nv, 0);
    for (const LoopCluster& cluster : SplitLoops(tree)) {
      for (const int v : cluster.v) ++uses[v];
    }
    for (const int count : uses) EXPECT_LE(count, 1) << tree.mechanism.name;
  }
  EXPECT_EQ(SplitLoops(Tower()).size(), 3u);
}

TEST(LoopClusters, HaveTheEquationsOfTheWhole) {
  constexpr double kRounding = 1e-13;
  Random random(5);
  for (const KinematicTree& tree : AllTrees()) {
    const VectorXd q = RandomCoordinates(tree, &random);
    const auto [e, C] = EquationsAt(tree, q);
    MatrixXd rest = C;
    int rows = 0;
    for (const LoopCluster& cluster : SplitLoops(tree)) {
      const auto [e_c, C_c] = EquationsAt(cluster.tree, q(cluster.q));
      for (size_t l = 0; l < cluster.joints.size(); ++l) {
        const Loop& part = cluster.tree.loops[l];
        const auto whole = std::find_if(tree.loops.begin(), tree.loops.end(), [&](const Loop& o) {
          return o.joint == cluster.joints[l];
        });
        ASSERT_EQ(part.rows, whole->rows);
        rows += part.rows;
        for (int i = 0; i < part.rows; ++i) {
          EXPECT_NEAR(e_c[part.row + i], e[whole->row + i], kRounding) << tree.mechanism.name;
          for (int v = 0; v < cluster.tree.nv; ++v) {
            EXPECT_NEAR(C_c(part.row + i, v), C(whole->row + i, cluster.v[v]), kRounding);
            rest(whole->row + i, cluster.v[v]) = 0;
          }
        }
      }
    }
    EXPECT_EQ(rows, tree.rows);
    EXPECT_TRUE((rest.array() == 0).all()) << tree.mechanism.name;
  }
}

TEST(LoopClusters, AreAssembledOneByOne) {
  const KinematicTree tree = Tower();
  const VectorXd given = StartCoordinates(tree);
  VectorXd q = given;
  const AssemblySummary summary = Assemble(tree, {}, &q);
  EXPECT_TRUE(summary.closed) << summary.message;
  const auto stays = [&](const char* joint) {
    const int i = CoordinateIndex(tree, FindJoint(tree.mechanism, joint), 0);
    return i < 0 || q[i] == given[i];
  };
  // The first storey is closed as it is given, the second is not.
  for (const char* joint : {"rocker", "a0", "b0", "c0", "d0", "up", "low"}) {
    EXPECT_TRUE(stays(joint)) << joint;
  }
  EXPECT_FALSE(stays("a1") && stays("b1") && stays("c1"));
}

TEST(LoopClusters, ThatCannotBeClosedAreNamed) {
  Mechanism mechanism = ParseMechanism(kTower, "tower.yaml");
  Link& coupler = mechanism.links[FindLink(mechanism, "floor1")];
  coupler.anchors[1].X_LA.p.x() = 50;  // d, out of reach
  const KinematicTree tree = BuildKinematicTree(mechanism);
  VectorXd q = StartCoordinates(tree);
  const AssemblySummary summary = Assemble(tree, {}, &q);
  EXPECT_FALSE(summary.closed);
  const std::string& name = mechanism.joints[summary.worst_joint].name;
  EXPECT_TRUE(name == "a1" || name == "b1" || name == "c1" || name == "d1") << name;
  EXPECT_NE(summary.message.find("through joint '" + name + "'"), std::string::npos);
}

TEST(Mobility, IsTheSumOverClustersAndWhatClosesNoLoop) {
  const KinematicTree tree = Tower();
  VectorXd q = StartCoordinates(tree);
  ASSERT_TRUE(Assemble(tree, {}, &q).closed);
  const Mobility mobility = AnalyseMobility(tree, q);
  EXPECT_EQ(mobility.mobility, 4);  // rocker, two parallelograms, door
  EXPECT_EQ(mobility.rank, 2 + 2 + 0);
  EXPECT_EQ(mobility.redundant, 3 + 3 + 5);
  EXPECT_FALSE(mobility.singular_here);
  for (size_t j = 0; j < mobility.joint_moves.size(); ++j) EXPECT_TRUE(mobility.joint_moves[j]);
}

TEST(Mobility, KnowsASingularClusterAmongOthers) {
  Mechanism mechanism = ParseMechanism(kTower, "tower.yaml");
  for (const char* name : {"a1", "b1", "c1", "d1"}) {
    mechanism.joints[FindJoint(mechanism, name)].start = {0};
  }
  const KinematicTree tree = BuildKinematicTree(mechanism);
  const Mobility mobility = AnalyseMobility(tree, StartCoordinates(tree));
  EXPECT_EQ(mobility.mobility, 4);
  EXPECT_TRUE(mobility.singular_here);
}

}  // namespace
}  // namespace vmech
