#include "vmech/kinematics/loops/loop_clusters.h"

#include <Eigen/Geometry>
#include <algorithm>

#include <gtest/gtest.h>

#include "support/examples.h"
#include "vmech/base/linear_algebra/linear_algebra.h"
#include "vmech/base/linear_algebra/normal_equations.h"
#include "vmech/kinematics/loops/assembled_mechanism.h"
#include "vmech/kinematics/loops/closure.h"
#include "vmech/kinematics/loops/dimensionless_loops.h"
#include "vmech/kinematics/loops/mechanism_parts.h"
#include "vmech/kinematics/loops/mobility.h"
#include "vmech/kinematics/loops/reconcile.h"

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

TEST(MechanismParts, HaveTheLoopsAndTheCoordinatesOfTheWhole) {
  constexpr double kRounding = 1e-12;
  Random random(6);
  for (const KinematicTree& tree : AllTrees()) {
    const VectorXd q = RandomCoordinates(tree, &random);
    const VectorXd e = EquationsAt(tree, q).first;
    int rows = 0;
    for (const MechanismPart& part : SplitMechanism(tree)) {
      EXPECT_EQ(part.tree.length, tree.length);
      const VectorXd e_p = EquationsAt(part.tree, q(part.q)).first;
      for (const Loop& loop : part.tree.loops) {
        const auto same = std::find_if(tree.loops.begin(), tree.loops.end(), [&](const Loop& o) {
          return o.joint == part.joints[loop.joint];
        });
        ASSERT_NE(same, tree.loops.end());
        const VectorXd difference =
            e_p.segment(loop.row, loop.rows) - e.segment(same->row, same->rows);
        EXPECT_LT(difference.norm(), kRounding) << tree.mechanism.name;
        rows += loop.rows;
      }
    }
    EXPECT_EQ(rows, tree.rows) << tree.mechanism.name;
  }
  EXPECT_EQ(SplitMechanism(Tower()).size(), 3u);
}

TEST(MechanismParts, WithAnAnchorInCommonStayTogether) {
  Mechanism mechanism = ParseMechanism(kTower, "tower.yaml");
  // The door hangs from where the second parallelogram is joined.
  mechanism.joints[FindJoint(mechanism, "up")].first.anchor = 1;
  const std::vector<MechanismPart> parts = SplitMechanism(BuildKinematicTree(mechanism));
  ASSERT_EQ(parts.size(), 2u);
  EXPECT_EQ(parts[0].joints.size(), 4u);
  EXPECT_EQ(parts[1].joints.size(), 6u);
}

/// Turns the axes of some links by less than a drawing shows.
void Round(Mechanism* mechanism, std::initializer_list<const char*> links) {
  constexpr double kRounding = 3e-7;
  for (const char* link : links) {
    Posed& X_LA = mechanism->links[FindLink(*mechanism, link)].anchors[1].X_LA;
    X_LA.R *= Eigen::AngleAxisd(kRounding, Vector3d::UnitX()).toRotationMatrix();
  }
}

TEST(Reconcile, MovesWhatIsRoundedAndNothingElse) {
  Mechanism drawn = ParseMechanism(kTower, "tower.yaml");
  {
    const KinematicTree tree = BuildKinematicTree(drawn);
    VectorXd q = StartCoordinates(tree);
    ASSERT_TRUE(Assemble(tree, {}, &q).closed);
    SetStarts(tree, q, &drawn);
  }
  Round(&drawn, {"p1", "q1"});
  const KinematicTree tree = BuildKinematicTree(drawn);
  const Reconciliation found = Reconcile(tree, StartCoordinates(tree));
  ASSERT_TRUE(found.closes);
  EXPECT_LE(found.misfit, 1e-12);
  EXPECT_GT(found.correction, 1e-8);
  EXPECT_LE(found.correction, 3e-7);
  const KinematicTree moved = BuildKinematicTree(found.mechanism);
  EXPECT_EQ(AnalyseMobility(moved, found.q).mobility, 4);
  for (const char* link : {"base", "rocker", "p0", "q0", "door"}) {
    const int index = FindLink(drawn, link);
    for (size_t a = 0; a < drawn.links[index].anchors.size(); ++a) {
      const Posed &before = drawn.links[index].anchors[a].X_LA,
                  &after = found.mechanism.links[index].anchors[a].X_LA;
      EXPECT_LT((after.R - before.R).norm() + (after.p - before.p).norm(), 1e-14) << link;
    }
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

void ExpectSame(const BlockNullSpace& blocks, const MatrixXd& A, const std::string& what) {
  constexpr double kRounding = 1e-11;
  const NullSpace dense = FindNullSpace(A, kRankTolerance);
  ASSERT_EQ(blocks.rank(), dense.rank) << what;
  ASSERT_EQ(blocks.dimension(), dense.basis.cols()) << what;
  const MatrixXd N = blocks.Basis();
  const MatrixXd difference = N * N.transpose() - dense.basis * dense.basis.transpose();
  EXPECT_LT(difference.norm(), kRounding) << what;
  const MatrixXd gram = N.transpose() * N;
  EXPECT_TRUE(gram.isIdentity(kRounding)) << what;
}

/// A chain of blocks: three rows, one of them redundant, of five columns, two of which the next
/// block has, too; of every third block only one.
std::vector<RowBlock> ChainOfBlocks(int count, int* columns) {
  Random random(3);
  std::vector<RowBlock> blocks;
  int first = 0;
  for (int b = 0; b < count; ++b) {
    RowBlock block{{}, MatrixXd(3, 5)};
    for (int k = 0; k < 5; ++k) block.columns.push_back(first + (3 * k) % 5);
    for (int i = 0; i < 10; ++i) block.A(i % 2, i / 2) = random.Between(-1, 1);
    block.A.row(2) = block.A.row(0) - 0.5 * block.A.row(1);
    first += b % 3 == 2 ? 4 : 3;
    blocks.push_back(block);
  }
  *columns = first + 6;  // the last is in no block
  return blocks;
}

TEST(BlockNullSpace, IsThatOfTheWholeMatrix) {
  int columns = 0;
  const std::vector<RowBlock> blocks = ChainOfBlocks(20, &columns);
  MatrixXd A = MatrixXd::Zero(60, columns);
  for (int b = 0; b < 20; ++b) A.middleRows(3 * b, 3)(Eigen::all, blocks[b].columns) = blocks[b].A;
  const BlockNullSpace whole(columns, blocks, kRankTolerance);
  ExpectSame(whole, A, "all columns");
  const MatrixXd N = whole.Basis();
  for (const size_t b : {0, 7, 19}) {
    const MatrixXd T = MatrixXd::Random(4, 5);
    const MatrixXd moved = T * N(blocks[b].columns, Eigen::all);
    EXPECT_LT((whole.LargestOf(b, T) - moved.rowwise().norm()).norm(), 1e-12) << b;
  }
  std::vector<bool> held(columns, false);
  MatrixXd of_held = MatrixXd::Zero(8, columns);
  for (int k = 0; k < 8; ++k) {
    held[7 * k] = true;
    of_held(k, 7 * k) = 1;
  }
  MatrixXd stacked(A.rows() + 8, columns);
  stacked << A, of_held;
  const MatrixXd M = BlockNullSpace(columns, blocks, kRankTolerance, held).Basis();
  EXPECT_EQ(M.cols(), columns - FindNullSpace(stacked, kRankTolerance).rank);
  EXPECT_LT((stacked * M).norm(), 1e-12);
  EXPECT_TRUE((M.transpose() * M).isIdentity(1e-12));
}

TEST(NormalEquations, AreSolvedWithinTheirEnvelope) {
  int columns = 0;
  const std::vector<RowBlock> blocks = ChainOfBlocks(20, &columns);
  MatrixXd A = MatrixXd::Zero(60, columns);
  for (int b = 0; b < 20; ++b) A.middleRows(3 * b, 3)(Eigen::all, blocks[b].columns) = blocks[b].A;
  Random random(4);
  const VectorXd e = random.Vector(60), b = random.Vector(columns);
  const VectorXd D = random.Vector(columns).array() + 1.1;
  const VectorXd x = SolveNormalEquations(blocks, e, D, b);
  const VectorXd left = A.transpose() * (A * x - e) + D.cwiseProduct(x) - b;
  EXPECT_LT(left.norm(), 1e-12);
  EXPECT_LT(ShareOfEnvelope(columns, blocks), 0.2);
  EXPECT_EQ(ShareOfEnvelope(5, {blocks[0]}), 1);
}

TEST(LoopNullSpace, IsThatOfTheLoopJacobian) {
  for (const KinematicTree& tree : AllTrees()) {
    VectorXd q = StartCoordinates(tree);
    ASSERT_TRUE(Assemble(tree, {}, &q).closed) << tree.mechanism.name;
    ExpectSame(LoopNullSpace(tree, q), DimensionlessLoopJacobian(tree, q), tree.mechanism.name);
  }
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
