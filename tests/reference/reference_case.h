#pragma once

#include <string>
#include <vector>

#include "support/examples.h"
#include "vmech/dynamics/loads/load_result.h"
#include "vmech/dynamics/loads/load_study.h"

namespace vmech::reference {

/// What the tests of this folder share: a shipped mechanism, put into a stated state, and the loads
/// in it in world axes.

/// Replaces the start of a joint.
void SetStart(Mechanism* mechanism, const std::string& joint, std::vector<double> start);

/// The loads after a joint has been led from its start to `position` in small steps: the assembly
/// mode stays that of the start.
PoseLoads AfterLeading(const Mechanism& mechanism, const std::string& joint, double position);
/// The same mechanism, starting there. For mechanisms without ball joints.
Mechanism LedTo(Mechanism mechanism, const std::string& joint, double position);

/// One drive and its state.
struct Driven {
  std::string joint;
  MotionSample state;
};

/// A study of one pose, in which the drives have the given states.
LoadStudy StudyAt(const Mechanism& mechanism, const std::vector<Driven>& drives);
PoseLoads LoadsAt(const Mechanism& mechanism, const std::vector<Driven>& drives);

/// The same states, but a hand at a grasp takes the place of the drives: it moves exactly as the
/// grasp does under them. `stiffness` weighs its wrench.
struct HeldLoads {
  PoseLoads loads;
  Wrenchd hand;  ///< on the mechanism, at the origin of the grasp, world axes
};
HeldLoads LoadsInHand(const Mechanism& mechanism, const std::string& grasp,
                      const Vector6d& stiffness, const std::vector<Driven>& drives,
                      ReactionRule rule);

/// A constant force in world axes at a point of a link.
ExternalLoad Force(const Mechanism& mechanism, const std::string& link, const Vector3d& p_L,
                   const Vector3d& force_W, const Vector3d& moment_W = Vector3d::Zero());

/// What the joint's first link exerts on its second, at the second anchor's origin, world axes.
Wrenchd OnSecond_W(const Mechanism& mechanism, const PoseLoads& loads, const std::string& joint);

/// Coordinate of a joint's first freedom.
double Position(const Mechanism& mechanism, const PoseLoads& loads, const std::string& joint);

/// The acceleration of a drive at which it need not exert any force: how the mechanism, which has
/// mobility 1, moves on its own. From two studies, as the force is linear in the acceleration.
double FreeAcceleration(const LoadStudy& study_of_one_pose, const std::string& joint,
                        double position, double velocity);

}  // namespace vmech::reference
