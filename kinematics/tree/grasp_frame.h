#pragma once

#include "vmech/kinematics/tree/kinematic_tree.h"

namespace vmech {

/// Where a hand holds a mechanism.
struct GraspFrame {
  int node = -1;                       ///< of the tree, that carries G; -1 is the ground
  Posed X_BG;                          ///< G in the node
  GraspKind kind = GraspKind::kRigid;  ///< kPoint: the three positional rows of e1 only
};

/// A grasp of the mechanism by its index.
GraspFrame GraspFrameOf(const KinematicTree& tree, int grasp);

}  // namespace vmech
