#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "vmech/dynamics/certainty.h"
#include "vmech/dynamics/pose_memory.h"
#include "vmech/dynamics/rule.h"
#include "vmech/kinematics/motion_law.h"
#include "vmech/mechanisms/mechanism.h"

namespace vmech {

/// A motor at a joint: one freedom of the joint moves as prescribed, whatever force that takes.
struct JointDrive {
  int joint = -1;
  int freedom = 0;
  MotionLaw law = MotionLaw::Uniform(0, 0);
};

/// A hand at a grasp: the mechanism follows it as closely as its loops allow (paper eq. 7).
struct HandDrive {
  int grasp = -1;
  HandLaw law;
  /// Weights of the pose error [N/m] and [N m/rad] (the rendering stiffness of paper eq. 11). Zero
  /// takes 1 N/m, and the square of the mechanism's characteristic length for rotations.
  Vector6d stiffness = Vector6d::Zero();
};

/// A wrench from outside on a link.
struct ExternalLoad {
  enum class Axes { kWorld, kLink };
  enum class Over { kConstant, kTime, kDriveCoordinate };

  int link = -1;
  Vector3d p_L = Vector3d::Zero();  ///< point of application in the link's drawing frame [m]
  Axes axes = Axes::kWorld;
  Over over = Over::kConstant;
  /// Rows of the table, increasing; a single row where constant. Linear between rows.
  std::vector<double> at;
  std::vector<Wrenchd> wrenches;
  /// Length after which the table repeats, in units of `at`; 0 if it does not. Outside a table that
  /// does not repeat the study is refused.
  double period = 0;
};

/// What is to be computed: a mechanism, its motion, and what acts on it.
struct LoadStudy {
  Mechanism mechanism;
  std::vector<JointDrive> drives;  ///< empty if the hand drives, or for a structure at rest
  std::optional<HandDrive> hand;
  std::vector<double> times;  ///< of the poses, increasing [s]
  /// Length of the cycle [s] if the motion repeats after it; 0 if it is one passage.
  double cycle = 0;
  std::vector<ExternalLoad> external;
  ReactionRule rule = ReactionRule::kStiffness;
  bool stop_at_limits = false;  ///< refuse a motion that leaves the limits of a joint
  /// Of messages: those of the study's figures.
  DisplayUnits units;
  /// The length by which `minimum_norm` weighs moments against forces [m]; 0 takes the mechanism's
  /// characteristic length.
  double norm_length = 0;
};

struct LoadStudyOptions {
  int threads = 1;                   ///< 1..64; the result does not depend on it
  double closure_tolerance = 1e-13;  ///< largest loop error that counts as closed, of the
                                     ///< characteristic length and of 1 rad
  bool link_motions = true;          ///< whether PoseLoads::links is wanted
  /// Called now and then with the number of poses done; false stops the study.
  std::function<bool(size_t done)> progress;

  void Validate() const;
};

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
  explicit PoseLoads(PoseMemory* memory);
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
  std::shared_ptr<PoseMemory> memory;
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

/// @throws std::invalid_argument for a study that contradicts itself, std::runtime_error with the
///         pose and its time where the motion cannot be followed (a dead centre, out of reach),
///         where it leaves limits at which it is to stop, or where a load acts on a freedom that
///         nothing resists.
LoadStudyResult RunLoadStudy(const LoadStudy& study, const LoadStudyOptions& options = {});

}  // namespace vmech
