#pragma once

#include <vector>

#include "vmech/kinematics/tree/kinematic_tree.h"

namespace vmech {

/// The velocities of a tree, divided into those that are chosen and those that follow.
struct CoordinatePartition {
  std::vector<int> driven;     ///< indices in v that a drive (or the hand) prescribes
  std::vector<int> idle;       ///< freedoms that no drive determines
  std::vector<int> dependent;  ///< the rest; the loop equations determine them
  /// Per v: its place in `dependent`, or -1.
  std::vector<int> dependent_slot;
};

/// The partition in which `driven` and `idle`, indices in v, are chosen and all others follow.
CoordinatePartition MakePartition(const KinematicTree& tree, std::vector<int> driven,
                                  std::vector<int> idle);

}  // namespace vmech
