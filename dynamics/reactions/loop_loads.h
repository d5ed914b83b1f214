#pragma once

#include <vector>

#include "vmech/kinematics/tree/kinematic_tree.h"

namespace vmech {

/// A loop whose multipliers load a joint, and the sense in which they enter the joint's W.
struct LoopLoad {
  int loop;     ///< index in KinematicTree::loops
  double sign;  ///< 1 or -1
};

/// Per joint of the mechanism: the loops that go through it, in their order.
std::vector<std::vector<LoopLoad>> LoopLoadsOfJoints(const KinematicTree& tree);

}  // namespace vmech
