#pragma once

#include <optional>
#include <vector>

#include "vmech/dynamics/loads/load_study.h"
#include "vmech/dynamics/reactions/reactions.h"
#include "vmech/kinematics/loops/coordinate_partition.h"
#include "vmech/kinematics/tree/kinematic_tree.h"

namespace vmech {

/// Everything about a study that does not change from pose to pose. Immutable.
struct LoadModel {
  KinematicTree tree;                            ///< driven joints are in it, not cut
  CoordinatePartition partition;                 ///< which velocities prescribe the others
  std::vector<JointCompliance> compliances;      ///< per joint of the mechanism
  std::vector<ExternalLoad> external;            ///< as LoadStudy::external
  std::vector<JointDrive> drives;                ///< as LoadStudy::drives
  std::optional<HandDrive> hand;                 ///< as LoadStudy::hand
  Vector6d hand_stiffness = Vector6d::Ones();    ///< K of the hand, diagonal
  ReactionRule rule = ReactionRule::kStiffness;  ///< how what statics leaves open is shared out
  double rounding = 0;  ///< of the mechanism's figures, as AssembledMechanism::correction
  /// Freedoms that neither drives nor the hand determine and that no load depends on, such as the
  /// spin of a rod between two spherical joints.
  int idle = 0;
  /// Moments of inertia up to here are rounding [kg m^2]: what they resist does not move.
  double no_inertia = 0;
  bool idle_is_held = false;       ///< idle freedoms do not move at all
  bool has_passive = false;        ///< springs, dampers or friction in some joint
  bool has_dry_friction = false;   ///< constant, or in proportion to loads
  bool has_load_friction = false;  ///< in proportion to loads
};

}  // namespace vmech
