#pragma once

#include <memory>
#include <vector>

#include "vmech/apps/haptic/held_mechanism.h"
#include "vmech/hw_interface/loop/loop_clock.h"
#include "vmech/hw_interface/masters/master.h"

namespace vmech {

using Masters = std::vector<std::unique_ptr<Master>>;  ///< one for each hand

/// The clock that a session goes by.
std::unique_ptr<LoopClock> ClockOf(const HapticArguments& arguments);

/// Runs the loop of configured masters, one for each hand, records and shows it as the arguments
/// say, and reports. Returns the program's exit code.
int HoldMechanism(const HeldMechanism& held, const HapticArguments& arguments,
                  const Masters& masters, LoopClock* clock);

}  // namespace vmech
