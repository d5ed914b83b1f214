#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "support/examples.h"
#include "vmech/kinematics/tree/forward_kinematics.h"
#include "vmech/mechanisms/dh/denavit_hartenberg.h"

namespace vmech {
namespace {

constexpr double kSamePose = 1e-12;  // metres and radians; mechanisms of about a metre

/// q of the tree as lists of each joint; those of cut joints stay at the start.
std::vector<std::vector<double>> CoordinatesOfJoints(const KinematicTree& tree, const VectorXd& q) {
  std::vector<std::vector<double>> lists;
  for (const Joint& joint : tree.mechanism.joints) lists.push_back(joint.start);
  for (const TreeNode& node : tree.nodes) {
    if (node.motion == NodeMotion::kFixed) continue;
    const int count = node.motion == NodeMotion::kSpherical ? 4 : 1;
    for (int i = 0; i < count; ++i) lists[node.joint][node.freedom + i] = q[node.q + i];
  }
  return lists;
}

void ExpectPose(const Posed& X, const Posed& expected, const std::string& what) {
  EXPECT_LT((X.R - expected.R).cwiseAbs().maxCoeff(), kSamePose) << what;
  EXPECT_LT((X.p - expected.p).cwiseAbs().maxCoeff(), kSamePose) << what;
}

class DhOfExample : public testing::TestWithParam<std::string> {};

TEST_P(DhOfExample, GivesThePosesOfForwardKinematics) {
  const KinematicTree tree = BuildKinematicTree(Example(GetParam()));
  const DhTable table = DeduceDhTable(tree.mechanism, tree.spanning);
  TreeWorkspace<double> ws(tree);
  Random random(11);
  for (int i = 0; i < 10; ++i) {
    const VectorXd q = RandomCoordinates(tree, &random, 2);
    ForwardKinematics(tree, q.data(), &ws);
    const std::vector<Posed> rows = DhPoses(table, CoordinatesOfJoints(tree, q));
    const auto in_world = [&](int link, const Posed& X_LQ) {
      return PoseInWorld(ws, tree.NodeOfLink(link), tree.X_node_link(link) * X_LQ);
    };
    for (size_t l = 0; l < tree.mechanism.links.size(); ++l) {
      ExpectPose(rows[table.row_of_link[l]], in_world(static_cast<int>(l), table.link_frames[l]),
                 tree.mechanism.links[l].name);
    }
    for (size_t g = 0; g < tree.mechanism.grasps.size(); ++g) {
      const Grasp& grasp = tree.mechanism.grasps[g];
      ExpectPose(rows[table.row_of_grasp[g]], in_world(grasp.link, grasp.X_LG), grasp.name);
    }
  }
}

TEST_P(DhOfExample, LeadsToBothSidesOfEveryCut) {
  const KinematicTree tree = BuildKinematicTree(Example(GetParam()));
  const DhTable table = DeduceDhTable(tree.mechanism, tree.spanning);
  TreeWorkspace<double> ws(tree);
  const VectorXd q = StartCoordinates(tree);
  ForwardKinematics(tree, q.data(), &ws);
  const std::vector<Posed> rows = DhPoses(table, CoordinatesOfJoints(tree, q));
  for (const Loop& loop : tree.loops) {
    const Joint& joint = tree.mechanism.joints[loop.joint];
    for (const AnchorId end : {joint.first, joint.second}) {
      const std::string axis = joint.name + " on " + tree.mechanism.links[end.link].name;
      size_t last = 0;  // the second of the two rows of that name
      for (size_t i = 0; i < rows.size(); ++i) {
        if (table.rows[i].axis == axis) last = i;
      }
      const Posed X_node_anchor = tree.X_node_link(end.link) * tree.mechanism.anchor(end).X_LA;
      ExpectPose(rows[last], PoseInWorld(ws, tree.NodeOfLink(end.link), X_node_anchor), axis);
    }
  }
}

std::vector<std::string> NamesWithRows() {
  std::vector<std::string> names = ExampleNames();
  names.push_back("puma-560");
  return names;
}

INSTANTIATE_TEST_SUITE_P(All, DhOfExample, testing::ValuesIn(NamesWithRows()),
                         [](const auto& info) { return TestName(info.param); });

}  // namespace
}  // namespace vmech
