#pragma once

#include "vmech/hw_interface/loop/loop_clock.h"
#include "vmech/hw_interface/masters/master.h"

namespace vmech {

/// Force that a device may be moved with by itself: a quarter of its peak, at most 2 N; 1 N where
/// its peak is unknown.
double GentleForce(const DeviceInfo& device);

/// Draws the handle of a configured master gently to a point of the device's axes [m], so that
/// there is room around it. @throws std::runtime_error if it does not come, with what is left.
void BringHome(Master* master, LoopClock* clock, const Vector3d& home);

}  // namespace vmech
