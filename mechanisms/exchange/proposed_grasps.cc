#include "vmech/mechanisms/exchange/proposed_grasps.h"

#include <fmt/format.h>

namespace vmech {
namespace {

/// Links that welds hold to the ground.
std::vector<bool> RigidWithGround(const Mechanism& mechanism) {
  std::vector<std::vector<int>> welded(mechanism.links.size());
  for (const Joint& joint : mechanism.joints) {
    if (joint.type != JointType::kWeld) continue;
    welded[joint.first.link].push_back(joint.second.link);
    welded[joint.second.link].push_back(joint.first.link);
  }
  std::vector<bool> rigid(mechanism.links.size(), false);
  std::vector<int> waiting{mechanism.ground};
  while (!waiting.empty()) {
    const int link = waiting.back();
    waiting.pop_back();
    if (rigid[link]) continue;
    rigid[link] = true;
    waiting.insert(waiting.end(), welded[link].begin(), welded[link].end());
  }
  return rigid;
}

}  // namespace

std::vector<int> LeafLinks(const Mechanism& mechanism) {
  std::vector<int> joints_of(mechanism.links.size(), 0);
  for (const Joint& joint : mechanism.joints) {
    ++joints_of[joint.first.link];
    ++joints_of[joint.second.link];
  }
  const std::vector<bool> rigid = RigidWithGround(mechanism);
  std::vector<int> leaves;
  for (size_t i = 0; i < joints_of.size(); ++i) {
    if (joints_of[i] == 1 && !rigid[i]) leaves.push_back(static_cast<int>(i));
  }
  return leaves;
}

void AddGraspAt(int link, Mechanism* mechanism) {
  const std::string& wanted = mechanism->links[link].name;
  std::string name = wanted;
  for (int i = 2; FindGrasp(*mechanism, name) >= 0; ++i) name = fmt::format("{}_{}", wanted, i);
  mechanism->grasps.push_back({name, link, {}, GraspKind::kRigid});
}

}  // namespace vmech
