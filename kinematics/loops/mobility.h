#pragma once

#include <vector>

#include "vmech/kinematics/loops/coordinate_partition.h"
#include "vmech/kinematics/tree/kinematic_tree.h"

namespace vmech {

/// How a mechanism can move, from the rank of its loop equations. Rank is judged at the given pose
/// and at closed poses near it: a rank that drops at one pose alone is a singular pose (a dead
/// centre), not a redundancy.
struct Mobility {
  int gruebler = 0;               ///< nv - rows: Gruebler's count
  int rank = 0;                   ///< of C, at a general pose nearby
  int mobility = 0;               ///< nv - rank
  int redundant = 0;              ///< rows - rank: equations that follow from the others
  bool singular_here = false;     ///< the rank is lower at the given pose
  std::vector<bool> joint_moves;  ///< per joint of the mechanism, at any of these poses
  VectorXd q_general;             ///< [nq] the closed pose nearby at which the rank was found
};

/// The mobility at q [nq], which must be a closed pose (Assemble).
Mobility AnalyseMobility(const KinematicTree& tree, const VectorXd& q);

/// Divides the velocities so that the loop equations determine all that no drive does; freedoms
/// that remain undetermined become idle.
/// @throws std::invalid_argument if the drives contradict each other (more drives than freedoms, or
///         two that move together).
CoordinatePartition PartitionForDrives(const KinematicTree& tree, const VectorXd& q_general,
                                       const std::vector<int>& driven);

/// Independent velocities for a mechanism that nothing prescribes yet, best conditioned at q.
CoordinatePartition PartitionAtPose(const KinematicTree& tree, const VectorXd& q);

}  // namespace vmech
