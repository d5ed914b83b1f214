#include "vmech/kinematics/tree/grasp_frame.h"

#include "vmech/mechanisms/validity.h"

namespace vmech {

GraspFrame GraspFrameOf(const KinematicTree& tree, int grasp) {
  RequireIndex("GraspFrameOf: grasp", grasp, tree.mechanism.grasps.size());
  const Grasp& g = tree.mechanism.grasps[grasp];
  return {tree.NodeOfLink(g.link), tree.X_node_link(g.link) * g.X_LG, g.kind};
}

}  // namespace vmech
