#pragma once

#include "vmech/hw_interface/device_info.h"
#include "vmech/kinematics/inverse_kinematics.h"

namespace vmech {

/// The share of a mechanism's inertia that a device can render from measured accelerations, in
/// (0, 1]: half of the handle's own inertia over that of the mechanism, in the motion allowed where
/// that is least. Delay in the acceleration turns rendered inertia against the device's own; at
/// equality it swings up (RenderingBounds::stable_inertia). With N the free motions at the closed
/// pose q and J the grasp's Jacobian,
///
///   share = min(1, 1/2 / lambda),   lambda the largest of  N' M N s = lambda (J N)' D J N s,
///
/// D the handle's masses. 1 for a device that states none: its passivity controller has to watch.
double StableInertiaShare(const KinematicTree& tree, const GraspFrame& grasp, const VectorXd& q,
                          const DeviceInfo& device);

}  // namespace vmech
