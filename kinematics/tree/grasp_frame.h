#pragma once

#include "vmech/kinematics/tree/kinematic_tree.h"

namespace vmech {

/// Where a hand holds a mechanism.
struct GraspFrame {
  int node = -1;                       ///< the node of the tree that carries G; -1 is the ground
  Posed X_BG;                          ///< pose of G in the node
  GraspKind kind = GraspKind::kRigid;  ///< kPoint: the three positional rows of e1 only
};

/// The frame of the mechanism's grasp with this index.
/// @throws std::invalid_argument if there is no such grasp.
GraspFrame GraspFrameOf(const KinematicTree& tree, int grasp);

}  // namespace vmech
