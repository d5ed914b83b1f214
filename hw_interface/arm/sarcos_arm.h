#pragma once

#include "vmech/hw_interface/arm/arm_model.h"

namespace vmech {

/// A Sarcos master arm: 7 revolute joints, shoulder to wrist, with a gripper at the hand. Geometry,
/// limits, torque ranges and identified inertias as published with an SL installation
/// (github.com/wonjsohn/sarcos, commit 979c5fb: master.dyn, SL_user.h, SensorOffset.cf,
/// Translation.cf, LinkParameters.cf of January 2012). That it is the paper's master is likely from
/// its 7 + 3 joints, not certain. The inertias are base parameters: they reproduce joint torques,
/// single links are not those of real bodies. The torque limits are the electronics' full scale.
/// Joint friction is not published; 0.3 N m s/rad at the shoulder down to 0.03 at the wrist is a
/// choice of ours. Base frame D: z up, gravity (0, 0, -9.81).
ArmDescription SarcosMasterArm();

/// Joint of the thumb that closes the gripper: range [rad] and full-scale torque [N m].
struct GripperRange {
  double closed = 0;           ///< [rad]
  double open = 0.814321;      ///< [rad]
  double torque_limit = 7.25;  ///< full scale [N m]
};

}  // namespace vmech
