#pragma once

#include "vmech/hw_interface/masters/operator_model.h"
#include "vmech/hw_interface/rendering/registration.h"
#include "vmech/kinematics/motion/motion_law.h"

namespace vmech {

/// The target of a simulated operator whose hand is to move by a law in the world until `end` [s],
/// and to stand there from then on.
HandMotion HandMotionOf(const HandLaw& law, double end, const Registration& registration);

}  // namespace vmech
