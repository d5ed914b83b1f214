#pragma once

#include <vector>

#include "vmech/kinematics/tree/kinematic_tree.h"

namespace vmech {

/// Loops that have a velocity or an anchor in common, as a mechanism of their own: the links around
/// them and the joints between these. The link that carries them all is its ground, since how that
/// one moves does not matter to them. It is cut where the whole is, and has its coordinates and its
/// characteristic length.
struct MechanismPart {
  KinematicTree tree;       ///< with its own ground
  std::vector<int> joints;  ///< for each joint of the part its index in the whole mechanism
  std::vector<int> q;       ///< indices in the whole tree's q [tree.nq]
};

/// The parts in the order of their first loops. What closes no loop is in none.
std::vector<MechanismPart> SplitMechanism(const KinematicTree& tree);

}  // namespace vmech
