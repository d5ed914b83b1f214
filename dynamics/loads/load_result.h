#pragma once

#include <array>
#include <memory>
#include <string>
#include <vector>

#include "vmech/dynamics/loads/pose/pose_arena.h"
#include "vmech/dynamics/reactions/certainty.h"
#include "vmech/kinematics/motion/motion_law.h"
#include "vmech/mechanisms/mechanism.h"

namespace vmech {

/// Motion of one link's drawing frame, world axes.
struct LinkMotion {
  Posed X_WL;
  Vector3d v = Vector3d::Zero(),
           w = Vector3d::Zero();  ///< velocity of Lo [m/s], angular velocity [rad/s]
  Vector3d a = Vector3d::Zero(),
           alpha =
               Vector3d::Zero();  ///< acceleration of Lo [m/s^2], angular acceleration [rad/s^2]
};

/// A motor, and the force that it exerts [N] or [N m].
struct DriveSample : MotionSample {
  double force = 0;
};

/// A joint, and the wrench which its first link exerts on the second, at the second anchor's
/// origin, in the axes of the first anchor.
struct JointSample : Wrenchd {
  Vector3d position = Vector3d::Zero();  ///< coordinates of its freedoms, unwrapped
  Vector3d rate = Vector3d::Zero();
};

/// One pose of the study.
struct PoseLoads {
  PoseLoads() = default;
  /// Keeps its arrays in `memory`.
  explicit PoseLoads(PoseArena* memory);
  /// What they take of it, in bytes.
  static size_t Size(size_t drive_count, size_t joint_count, size_t link_count);

  double time = 0;
  PoseArray<DriveSample> drives;  ///< of each joint drive
  Wrenchd hand;                   ///< w_d: what the hand does to the mechanism at Go, world axes
  double hand_error = 0;          ///< distance that the hand is off the grasp frame [m]
  PoseArray<JointSample> joints;  ///< of each joint of the mechanism
  PoseArray<LinkMotion> links;    ///< empty if LoadStudyOptions::link_motions is off
  double power = 0;               ///< of the drives and the hand [W]
  double power_error = 0;  ///< power in, less d/dt energy and losses, over the largest sum of the
                           ///< terms at any pose of the study
  double power_error_scale = 0;  ///< the sum of those terms here [W]
  /// sin^2 of the angle by which the drive's hold on the mechanism is short of none; 0 at a dead
  /// centre.
  double smallest_pivot = 1;
  double closure = 0;     ///< loop error that is left, dimensionless
  double unresisted = 0;  ///< largest force along an idle freedom without inertia [N], [N m]
  /// Load-dependent friction has no equilibrium here: the mechanism locks itself. The joint
  /// wrenches are those of the last iteration.
  bool jammed = false;
  int locking_joint = -1;  ///< where jammed: the joint whose friction takes the most power
  /// The drive stands still and dry friction alone holds what it would have to hold.
  bool held_by_friction = false;
};

struct LoadStudyResult {
  /// Behind the arrays of `poses`. Copy a pose to keep it for longer than the result.
  std::shared_ptr<PoseArena> memory;
  PoseArray<PoseLoads> poses;
  std::vector<JointCertainty> certainty;   ///< per joint; `singular` only if it is so at every pose
  std::vector<Certainty> drive_certainty;  ///< per drive: determined, or not (kNotDetermined)
  std::vector<size_t> singular_poses;      ///< indices of poses at or very near a dead centre
  int mobility = 0;
  int redundant_equations = 0;
  std::vector<std::string> cut_joints;
  std::vector<std::string> idle;  ///< freedoms that move nothing the loads depend on
  double norm_length = 0;  ///< used by minimum_norm, and for stiffness where none is given [m]
  double max_closure = 0;
  double max_power_error = 0;
  std::vector<std::string> warnings;
  std::vector<std::string> notes;  ///< what the assembly did, as AssembledMechanism::Notes
  /// Per joint and component: not determined by statics, and loaded by this study. What is zero at
  /// every pose whatever the stiffnesses, as forces across the plane of a planar load are, is not.
  std::vector<std::array<bool, 6>> open;
  std::string BriefReport() const;
};

}  // namespace vmech
