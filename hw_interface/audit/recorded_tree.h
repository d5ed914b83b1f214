#pragma once

#include <vector>

#include "vmech/hw_interface/recording/recording.h"
#include "vmech/kinematics/tree/grasp_frame.h"
#include "vmech/kinematics/tree/kinematic_tree.h"

namespace vmech {

/// The mechanism of a recording, as the session had it.
struct RecordedTree {
  /// @throws std::invalid_argument if the recording does not hold its mechanism, names no grasp of
  /// it, or has other coordinates; FileErrors if that mechanism cannot be read.
  explicit RecordedTree(const RecordingHeader& header);
  /// The mechanism of a session that runs here; `index` of the grasp.
  RecordedTree(const KinematicTree& held, int index, bool gripper);

  KinematicTree tree;    ///< whose q and v the ticks hold
  int grasp_index = -1;  ///< index in the mechanism's grasps
  GraspFrame grasp;      ///< on its link
  // Of every hand; the first is the one above.
  std::vector<int> grasp_indices;  ///< as grasp_index
  std::vector<GraspFrame> grasps;  ///< as grasp
  bool regrasps = false;           ///< the hand lets go and takes hold elsewhere, as with a gripper
};

/// What stands for a mechanism in the recordings of its sessions.
RecordedMechanism RecordedMechanismOf(const KinematicTree& tree);

}  // namespace vmech
