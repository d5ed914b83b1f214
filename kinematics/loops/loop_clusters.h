#pragma once

#include <vector>

#include "vmech/kinematics/tree/kinematic_tree.h"

namespace vmech {

/// Loops that have velocities in common, as a tree of their own. Loops of different clusters have
/// none: the equations of a mechanism fall apart into those of its clusters, which are solved one
/// by one, in time and memory linear in their number.
struct LoopCluster {
  /// The loops and the nodes around them; the node that carries them all stands for the ground,
  /// since its pose does not matter to them. Of the mechanism only what is cut here is there: its
  /// joints are those of the loops, in their order; nodes have none, and there are no links.
  KinematicTree tree;
  std::vector<int> nodes;   ///< for each node of the cluster its index in the whole tree
  std::vector<int> q, v;    ///< indices in the whole tree's q [tree.nq] and v [tree.nv]
  std::vector<int> joints;  ///< for each loop the index of its joint in the whole mechanism
};

/// The clusters in the order of their first loops. Coordinates that close no loop are in none.
std::vector<LoopCluster> SplitLoops(const KinematicTree& tree);

}  // namespace vmech
