#pragma once

#include "vmech/hw_interface/masters/operator_model.h"
#include "vmech/hw_interface/rendering/tick.h"
#include "vmech/kinematics/motion/motion_law.h"

namespace vmech {

/// The target of a simulated operator whose hand is to move by a law in the world.
HandMotion HandMotionOf(const HandLaw& law, const Registration& registration);

}  // namespace vmech
