#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "vmech/dynamics/loads/load_result.h"
#include "vmech/dynamics/reactions/rule.h"
#include "vmech/kinematics/motion/motion_law.h"
#include "vmech/mechanisms/mechanism.h"

namespace vmech {

/// A motor at a joint: one freedom of the joint, which is not spherical, moves as prescribed,
/// whatever force that takes.
struct JointDrive {
  int joint = -1;                            ///< index in Mechanism::joints
  int freedom = 0;                           ///< counted from 0
  MotionLaw law = MotionLaw::Uniform(0, 0);  ///< of the coordinate [m] or [rad], over time
};

/// A hand at a grasp: the mechanism follows it as closely as its loops allow (paper eq. 7).
struct HandDrive {
  int grasp = -1;  ///< index in Mechanism::grasps
  HandLaw law;     ///< where the hand is over time
  /// Weights of the pose error [N/m] and [N m/rad] (the rendering stiffness of paper eq. 11). Zero
  /// takes 1 N/m, and the square of the mechanism's characteristic length for rotations.
  Vector6d stiffness = Vector6d::Zero();
};

/// The numbers of a wrench that acts on a link from outside.
template <typename T>
struct LoadTableOf {
  Vector3<T> p_L = Vector3<T>::Zero();  ///< point of application in the link's drawing frame [m]
  /// Rows of the table, increasing; a single row where constant. Linear between rows.
  std::vector<T> at;
  std::vector<Wrench<T>> wrenches;  ///< [rows] force [N], then moment [N m] about the point
  /// Length after which the table repeats, in units of `at`; 0 if it does not. Outside a table that
  /// does not repeat the study is refused.
  T period = 0;
};

/// A wrench that acts on a link from outside.
struct ExternalLoad : LoadTableOf<double> {
  /// The axes in which the wrench's components are given.
  enum class Axes { kWorld, kLink };
  /// The argument of the table, which `at` has the values of.
  enum class Over { kConstant, kTime, kDriveCoordinate };

  int link = -1;                ///< index in Mechanism::links
  Axes axes = Axes::kWorld;     ///< the link's are those of its drawing
  Over over = Over::kConstant;  ///< time [s], or the first drive's coordinate [m] or [rad]
};

/// What is to be computed: a mechanism, its motion, and what acts on it.
struct LoadStudy {
  Mechanism mechanism;             ///< as its file describes it
  std::vector<JointDrive> drives;  ///< empty if the hand drives, or for a structure at rest
  std::optional<HandDrive> hand;   ///< drives in place of `drives`
  std::vector<double> times;       ///< of the poses, increasing [s]
  /// Length of the cycle [s] if the motion repeats after it; 0 if it is one passage.
  double cycle = 0;
  std::vector<ExternalLoad> external;            ///< act at every pose, beside weight
  ReactionRule rule = ReactionRule::kStiffness;  ///< how what statics leaves open is shared out
  bool stop_at_limits = false;  ///< refuse a motion that leaves the limits of a joint
  /// The units in which messages about the study speak.
  DisplayUnits units;
  /// The length by which `minimum_norm` weighs moments against forces [m]; 0 takes the mechanism's
  /// characteristic length.
  double norm_length = 0;
};

/// How a load study is run; the mechanism and its motion are in LoadStudy.
struct LoadStudyOptions {
  int threads = 1;                   ///< 1..64; the result does not depend on it
  double closure_tolerance = 1e-13;  ///< largest loop error, of the characteristic length and of
                                     ///< 1 rad, that counts as closed, (0, 1e-6]
  bool link_motions = true;          ///< whether PoseLoads::links is wanted
  /// Called now and then with the number of poses done; false stops the study.
  std::function<bool(size_t done)> progress;

  void Validate() const;  ///< @throws std::invalid_argument naming field, value and range
};

}  // namespace vmech
