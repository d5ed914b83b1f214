#include "vmech/hw_interface/audit/recorded_tree.h"

#include <fmt/format.h>

#include <stdexcept>
#include <utility>

#include "vmech/dynamics/in_hand/passive_joints.h"
#include "vmech/mechanisms/files/reader.h"
#include "vmech/mechanisms/files/writer.h"

namespace vmech {
namespace {

KinematicTree TreeOf(const RecordingHeader& header) {
  if (header.mechanism.text.empty()) {
    throw std::invalid_argument(fmt::format(
        "the recording of '{}' does not hold its mechanism; `vmech replay OLD --record NEW` makes "
        "one that does",
        header.device));
  }
  Mechanism mechanism = ParseMechanism(header.mechanism.text, "the recorded mechanism");
  const SpanningTreeOptions cuts = KeepPassiveJoints(mechanism);
  return BuildKinematicTree(std::move(mechanism), cuts);
}

}  // namespace

RecordedTree::RecordedTree(const RecordingHeader& header)
    : tree(TreeOf(header)),
      grasp_index(FindGrasp(tree.mechanism, header.Note("grasp"))),
      regrasps(header.Number("gripper", 0) != 0) {
  for (int hand = 0; hand < header.hands(); ++hand) {
    const std::string name = header.Note(RecordingHeader::KeyOf("grasp", hand));
    const int index = FindGrasp(tree.mechanism, name);
    if (index < 0) {
      throw std::invalid_argument(fmt::format("the recorded mechanism has no grasp '{}'", name));
    }
    grasp_indices.push_back(index);
    grasps.push_back(GraspFrameOf(tree, index));
  }
  grasp = grasps.front();
  const RecordedMechanism& names = header.mechanism;
  const bool fits = static_cast<int>(names.coordinates.size()) == tree.nq &&
                    static_cast<int>(names.velocities.size()) == tree.nv &&
                    names.joints.size() == tree.mechanism.joints.size();
  if (!fits) throw std::invalid_argument("the ticks of the recording are of another mechanism");
}

RecordedTree::RecordedTree(const KinematicTree& held, int index, bool gripper)
    : tree(held),
      grasp_index(index),
      grasp(GraspFrameOf(tree, index)),
      grasp_indices{index},
      grasps{grasp},
      regrasps(gripper) {}

RecordedMechanism RecordedMechanismOf(const KinematicTree& tree) {
  RecordedMechanism recorded;
  recorded.text = WriteMechanism(tree.mechanism);
  recorded.coordinates.resize(static_cast<size_t>(tree.nq));
  for (const TreeNode& node : tree.nodes) {
    if (node.v < 0) continue;
    const bool whole = node.motion == NodeMotion::kSpherical;
    const std::string name =
        whole ? tree.mechanism.joints[node.joint].name : NameOfVelocity(tree, node.v);
    for (int i = 0; i < (whole ? 4 : 1); ++i) {
      recorded.coordinates[node.q + i] = whole ? fmt::format("{}.{}", name, "wxyz"[i]) : name;
    }
  }
  for (int v = 0; v < tree.nv; ++v) recorded.velocities.push_back(NameOfVelocity(tree, v));
  for (const Joint& joint : tree.mechanism.joints) recorded.joints.push_back(joint.name);
  return recorded;
}

}  // namespace vmech
