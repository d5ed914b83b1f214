#pragma once

#include <memory>
#include <vector>

#include "vmech/mechanisms/mechanism.h"

namespace vmech::peers {

/// A mechanism as Simbody sees it: a second opinion on accelerations and joint reactions by a
/// library that nobody here wrote [Sherman, Seth & Delp 2011]. Only the description is shared with
/// vmech; tree, kinematics and dynamics are Simbody's. Springs, dampers and friction of the joints
/// are not modelled: a caller who needs them passes their forces as external wrenches.

/// Pose and velocity of a link in the world, axes of W.
struct LinkMotion {
  Posed X_WL;
  Vector3d v_WLo = Vector3d::Zero();  ///< velocity of the link's origin [m/s]
  Vector3d w_WL = Vector3d::Zero();   ///< angular velocity [rad/s]
};

/// Acceleration of a link in the world, axes of W.
struct LinkAcceleration {
  Vector3d a_WLo = Vector3d::Zero();     ///< of the link's origin [m/s^2]
  Vector3d alpha_WL = Vector3d::Zero();  ///< angular [rad/s^2]
};

/// One freedom of one joint, in the order in which JointType lists them.
struct JointFreedom {
  int joint = -1;
  int freedom = 0;
};

/// What is known about the driven freedoms.
enum class DriveMode {
  kAcceleration,  ///< their accelerations [m/s^2 or rad/s^2], of all freedoms of a driven joint;
                  ///< the forces are found
  kForce,         ///< their forces [N or N m]; the accelerations are found
};

struct SimbodyQuery {
  std::vector<LinkMotion> links;    ///< one per link of the mechanism
  std::vector<double> drives;       ///< one per driven freedom, see DriveMode
  std::vector<Wrenchd> external_W;  ///< on each link, about Lo, axes of W; empty if there are none
};

struct SimbodyAnswer {
  /// Per joint: the wrench which the first link exerts on the second, about the origin of the
  /// second anchor, in the axes of the first anchor. Includes the force of the drive.
  std::vector<Wrenchd> joints;
  std::vector<double> drive_forces;             ///< on the second link by the first [N or N m]
  std::vector<LinkAcceleration> accelerations;  ///< per link
  double pose_error = 0;  ///< largest departure of Simbody's poses from those asked for [m, rad]
  double velocity_error = 0;  ///< the same for velocities [m/s, rad/s]
};

class SimbodyModel {
 public:
  /// Driven joints and screws belong to the spanning tree; then those with the fewest freedoms.
  /// @throws std::invalid_argument if driven joints and screws close a loop among themselves, a
  ///   link is not connected to ground, or only some freedoms of a joint are to be accelerated.
  SimbodyModel(const Mechanism& mechanism, std::vector<JointFreedom> drives, DriveMode mode);
  ~SimbodyModel();
  SimbodyModel(SimbodyModel&&) noexcept;
  SimbodyModel& operator=(SimbodyModel&&) noexcept;

  /// Switches off the loop equations that depend on the others at this pose, as an author who
  /// knows the linkage would leave them out. Without it Simbody shares reactions that statics does
  /// not determine in its own way; what statics determines is the same. Returns how many remain.
  int DropRedundantEquations(const std::vector<LinkMotion>& links);

  /// Is this joint one of the tree, rather than a loop constraint?
  bool IsTreeJoint(int joint) const;

  void Evaluate(const SimbodyQuery& query, SimbodyAnswer* answer);
  SimbodyAnswer Evaluate(const SimbodyQuery& query);

  /// Computes the accelerations anew, from the coordinates and speeds of the last Evaluate: what an
  /// integrator asks for at every evaluation.
  void Accelerate();

 private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace vmech::peers
