#include "vmech/mechanisms/dh/denavit_hartenberg.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "support/examples.h"
#include "vmech/mechanisms/mass_properties.h"

namespace vmech::denavit_hartenberg_test {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kPoses = 1e-9;      // feet of nearly parallel axes up to 1e4 m away
constexpr double kRounding = 1e-12;  // a few products of figures of order one

using Coordinates = std::vector<std::vector<double>>;

Posed Rotation(double angle, const Vector3d& axis) {
  return {Eigen::AngleAxisd(angle, axis).toRotationMatrix(), Vector3d::Zero()};
}

Posed Translation(double x, double y, double z) {
  return {Matrix3d::Identity(), Vector3d(x, y, z)};
}

/// X_FM(q) as docs/file-format.md has it.
Posed PoseOfJoint(const Joint& joint, const std::vector<double>& q) {
  const Vector3d x = Vector3d::UnitX(), y = Vector3d::UnitY(), z = Vector3d::UnitZ();
  switch (joint.type) {
    case JointType::kRevolute:
      return Rotation(q[0], z);
    case JointType::kPrismatic:
      return Translation(0, 0, q[0]);
    case JointType::kCylindrical:
      return Translation(0, 0, q[0]) * Rotation(q[1], z);
    case JointType::kScrew:
      return Translation(0, 0, joint.pitch * q[0]) * Rotation(q[0], z);
    case JointType::kUniversal:
      return Rotation(q[0], x) * Rotation(q[1], y);
    case JointType::kSpherical:
      return {Eigen::Quaterniond(q[0], q[1], q[2], q[3]).toRotationMatrix(), Vector3d::Zero()};
    case JointType::kPlanar:
      return Translation(q[0], q[1], 0) * Rotation(q[2], z);
    case JointType::kWeld:
      return {};
  }
  return {};
}

/// Poses of the links of a tree, anchor by anchor.
std::vector<Posed> LinkPoses(const Mechanism& mechanism, const SpanningTree& tree,
                             const Coordinates& q) {
  std::vector<Posed> poses(mechanism.links.size());
  for (const SpanningTree::Branch& branch : tree.branches) {
    const Joint& joint = mechanism.joints[branch.joint];
    const Posed X_first_second = mechanism.anchor(joint.first).X_LA *
                                 PoseOfJoint(joint, q[branch.joint]) *
                                 mechanism.anchor(joint.second).X_LA.inverse();
    const bool reversed = joint.first.link == branch.child_link;
    poses[branch.child_link] =
        poses[branch.parent_link] * (reversed ? X_first_second.inverse() : X_first_second);
  }
  return poses;
}

double Defect(const Posed& X, const Posed& Y) {
  const double defect =
      std::max((X.R - Y.R).cwiseAbs().maxCoeff(), (X.p - Y.p).cwiseAbs().maxCoeff());
  return std::isfinite(defect) ? defect : 1e300;
}

Posed RandomPose(Random* random) {
  return {AxesFromZX(random->Vector(3), random->Vector(3)), random->Vector(3)};
}

/// From one axis to the next: skew, parallel, antiparallel, intersecting, coincident, or nearly
/// parallel by 1e-3 to 1e-12 rad.
Posed RandomPair(Random* random) {
  const Posed along = Rotation(random->Between(-3, 3), Vector3d::UnitZ()) *
                      Translation(0, 0, random->Between(-1, 1));
  const Posed aside = Rotation(random->Between(-3, 3), Vector3d::UnitZ()) *
                      Translation(random->Between(0, 1), 0, random->Between(-1, 1));
  const Vector3d across = AxesFromZX(Vector3d::UnitZ(), random->Vector(3)).col(0);
  switch (static_cast<int>(random->Between(0, 6))) {
    case 0:
      return RandomPose(random);
    case 1:
      return aside * along;
    case 2:
      return aside * Rotation(kPi, across) * along;
    case 3:
      return Translation(0, 0, random->Between(-1, 1)) * Rotation(random->Between(0.1, 3), across) *
             along;
    case 4:
      return random->Between(0, 1) < 0.5 ? along : along * Rotation(kPi, across) * along;
    default:
      return aside * Rotation(std::pow(10, random->Between(-12, -3)), across) * along;
  }
}

const JointType kTypes[] = {JointType::kRevolute,  JointType::kPrismatic, JointType::kCylindrical,
                            JointType::kScrew,     JointType::kUniversal, JointType::kSpherical,
                            JointType::kPlanar,    JointType::kWeld,      JointType::kRevolute,
                            JointType::kPrismatic, JointType::kRevolute,  JointType::kRevolute};

/// A tree of `count` moving links, each on the one before it or on any of them; joints in both
/// senses.
Mechanism RandomTree(int count, bool branches, Random* random) {
  Mechanism mechanism;
  mechanism.links.push_back({"ground", {}, {}});
  std::vector<Posed> carried(1);  // the anchor that carries each link
  for (int i = 1; i <= count; ++i) {
    const int parent = branches ? static_cast<int>(random->Between(0, i)) : i - 1;
    Link& below = mechanism.links[parent];
    below.anchors.push_back({"out" + std::to_string(i), carried[parent] * RandomPair(random)});
    carried.push_back(RandomPose(random));
    const AnchorId out{parent, static_cast<int>(below.anchors.size()) - 1}, in{i, 0};
    mechanism.links.push_back({"link" + std::to_string(i), {}, {{"in", carried[i]}}});
    const bool reversed = random->Between(0, 1) < 0.3;
    const JointType type = kTypes[static_cast<int>(random->Between(0, std::size(kTypes)))];
    mechanism.joints.push_back(
        MakeJoint("j" + std::to_string(i), type, reversed ? in : out, reversed ? out : in));
    if (type == JointType::kScrew) mechanism.joints.back().pitch = 0.01;
  }
  mechanism.grasps.push_back({"tip", count, RandomPose(random), GraspKind::kRigid});
  return mechanism;
}

Coordinates RandomCoordinates(const Mechanism& mechanism, Random* random) {
  Coordinates q;
  for (const Joint& joint : mechanism.joints) {
    VectorXd values = random->Vector(CoordinatesOf(joint.type), 3);
    if (joint.type == JointType::kSpherical) values.normalize();
    q.emplace_back(values.begin(), values.end());
  }
  return q;
}

double WorstPose(const Mechanism& mechanism, Random* random) {
  const SpanningTree tree = FindSpanningTree(mechanism);
  const DhTable table = DeduceDhTable(mechanism, tree);
  const Coordinates q = RandomCoordinates(mechanism, random);
  const std::vector<Posed> links = LinkPoses(mechanism, tree, q), rows = DhPoses(table, q);
  double worst = 0;
  for (size_t i = 0; i < links.size(); ++i) {
    const Posed X_WD = links[i] * table.link_frames[i];
    worst = std::max(worst, Defect(rows[table.row_of_link[i]], X_WD) / (1 + X_WD.p.norm()));
  }
  const Grasp& grasp = mechanism.grasps[0];
  return std::max(worst, Defect(rows[table.row_of_grasp[0]], links[grasp.link] * grasp.X_LG));
}

TEST(DhTable, GivesThePosesOfTenThousandRandomChains) {
  Random random(3);
  for (int i = 0; i < 10000; ++i) {
    const int count = static_cast<int>(random.Between(1, 9));
    ASSERT_LT(WorstPose(RandomTree(count, false, &random), &random), kPoses) << "chain " << i;
  }
}

TEST(DhTable, GivesThePosesOfRandomTreesWhoseLinksCarrySeveralJoints) {
  Random random(4);
  for (int i = 0; i < 2000; ++i) {
    const int count = static_cast<int>(random.Between(2, 9));
    ASSERT_LT(WorstPose(RandomTree(count, true, &random), &random), kPoses) << "tree " << i;
  }
}

TEST(DhTable, HasTheTwoExtraParametersOnBranchesOnly) {
  Random random(5);
  const Mechanism mechanism = RandomTree(8, true, &random);
  const DhTable table = DeduceDhTable(mechanism, FindSpanningTree(mechanism));
  int branches = 0;
  for (size_t i = 0; i < table.rows.size(); ++i) {
    const DhRow& row = table.rows[i];
    const bool first = row.link < 0 || table.row_of_link[row.link] == static_cast<int>(i);
    EXPECT_TRUE(!first || (row.gamma == 0 && row.b == 0)) << row.axis;
    branches += row.gamma != 0 || row.b != 0 ? 1 : 0;
  }
  EXPECT_GT(branches, 0);
}

TEST(DhTable, TakesSixParametersInTwoRowsForAGrasp) {
  Random random(6);
  const Mechanism mechanism = RandomTree(1, false, &random);
  const DhTable table = DeduceDhTable(mechanism, FindSpanningTree(mechanism));
  const DhRow& second = table.rows[table.row_of_grasp[0]];
  EXPECT_EQ(second.from, table.row_of_link[1]);
  EXPECT_EQ(second.motion, DhMotion::kFixed);
  EXPECT_EQ(second.parameters.a, 0);
  EXPECT_EQ(second.parameters.alpha, 0);
  EXPECT_EQ(table.rows[second.from].axis, "grasp tip");
}

TEST(DhTable, PutsLinksOfNoLengthBetweenTheFreedomsOfAJoint) {
  Mechanism mechanism;
  mechanism.links = {{"ground", {}, {{"a", {}}}}, {"cross", {}, {{"a", {}}}}};
  mechanism.joints = {MakeJoint("u", JointType::kUniversal, {0, 0}, {1, 0})};
  const DhTable table = DeduceDhTable(mechanism, FindSpanningTree(mechanism));
  ASSERT_EQ(table.rows.size(), 3u);
  const DhRow& between = table.rows[1];
  EXPECT_EQ(between.axis, "u.ry");
  EXPECT_EQ(between.link, -1);
  EXPECT_EQ(between.relation, AxesRelation::kIntersecting);
  EXPECT_NEAR(std::abs(between.parameters.alpha), kPi / 2, kRounding);
  EXPECT_EQ(between.parameters.a, 0);
}

TEST(DrawnInLinkFrames, MovesMassPropertiesWithTheirLink) {
  Random random(7);
  Mechanism mechanism = RandomTree(3, false, &random);
  MassProperties& body = mechanism.links[2].mass_properties;
  body = {2.0, random.Vector(3),
          RotatedInertia(RandomPose(&random).R, Vector3d(1, 2, 2.5).asDiagonal())};
  const SpanningTree tree = FindSpanningTree(mechanism);
  const DhTable table = DeduceDhTable(mechanism, tree);
  const Mechanism drawn = DrawnInLinkFrames(mechanism, table);
  const Coordinates q = RandomCoordinates(mechanism, &random);
  const Posed X_WL = LinkPoses(mechanism, tree, q)[2], X_WD = LinkPoses(drawn, tree, q)[2];
  const MassProperties& moved = drawn.links[2].mass_properties;
  EXPECT_LT(Defect(X_WD, X_WL * table.link_frames[2]), kPoses);
  EXPECT_LT((X_WD * moved.p_LoLcm - X_WL * body.p_LoLcm).norm(), kPoses);
  EXPECT_LT((RotatedInertia(X_WD.R, moved.I_Lcm) - RotatedInertia(X_WL.R, body.I_Lcm)).norm(),
            kPoses);
}

TEST(DrawnInLinkFrames, LeavesEveryLinkInItsDhFrame) {
  Random random(8);
  const Mechanism mechanism = RandomTree(6, true, &random);
  const SpanningTree tree = FindSpanningTree(mechanism);
  const Mechanism drawn = DrawnInLinkFrames(mechanism, DeduceDhTable(mechanism, tree));
  const DhTable again = DeduceDhTable(drawn, tree);
  for (size_t i = 1; i < drawn.links.size(); ++i) {
    EXPECT_LT(Defect(again.link_frames[i], Posed()), kPoses) << drawn.links[i].name;
  }
}

}  // namespace
}  // namespace vmech::denavit_hartenberg_test
