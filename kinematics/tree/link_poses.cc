#include "vmech/kinematics/tree/link_poses.h"

#include "vmech/kinematics/tree/forward_kinematics.h"

namespace vmech {

std::vector<Posed> LinkPoses(const KinematicTree& tree, const VectorXd& q) {
  TreeWorkspace<double> ws(tree);
  ForwardKinematics(tree, q.data(), &ws);
  std::vector<Posed> poses;
  for (int link = 0; link < static_cast<int>(tree.mechanism.links.size()); ++link) {
    poses.push_back(PoseInWorld(ws, tree.NodeOfLink(link), tree.X_node_link(link)));
  }
  return poses;
}

}  // namespace vmech
