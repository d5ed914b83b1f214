#pragma once

#include "vmech/kinematics/assembly.h"
#include "vmech/mechanisms/mechanism.h"

namespace vmech {

/// The mechanism with its loops closed: the start values of its joints, cut ones included, are
/// those of the assembled pose. As it is where they close to rounding already.
/// @throws std::runtime_error with the joint and the gap if the loops do not close.
Mechanism Assembled(const Mechanism& mechanism);

}  // namespace vmech
