#include "vmech/dynamics/reactions/loop_loads.h"

namespace vmech {

std::vector<std::vector<LoopLoad>> LoopLoadsOfJoints(const KinematicTree& tree) {
  std::vector<std::vector<LoopLoad>> loads(tree.mechanism.joints.size());
  for (size_t l = 0; l < tree.loops.size(); ++l) {
    const Loop& loop = tree.loops[l];
    const int index = static_cast<int>(l);
    loads[loop.joint].push_back({index, 1.0});
    for (const LoopNode& n : loop.path) {
      const TreeNode& node = tree.nodes[n.node];
      if (tree.placements[node.joint].tree_node != n.node) continue;
      loads[node.joint].push_back({index, node.reversed ? n.sign : -n.sign});
    }
  }
  return loads;
}

}  // namespace vmech
