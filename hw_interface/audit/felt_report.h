#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "vmech/hw_interface/safety/safety_filter.h"

namespace vmech {

/// A figure that was fitted to a session.
struct Felt {
  double value = 0;     ///< the estimate, in the unit of the figure
  double error = 0;     ///< standard error
  double promised = 0;  ///< what the session was set up for
  bool known = false;   ///< false: the session has not shown it
};

/// What a session tells of itself.
struct FeltReport {
  std::uint64_t ticks = 0;  ///< that were looked at
  double period = 1e-3;     ///< of the loop [s]
  double share = 1;         ///< of the inertia that was rendered, on average [-]
  Felt inertia;             ///< felt along the free motion, over that share of the mechanism's [-]
  Felt weight;              ///< the same of its weight [-]
  Felt damping;             ///< felt along the free motion beyond the mechanism's own [N s/m]
  Felt stiffness;           ///< against the constraints [N/m]
  Felt resistance;          ///< damping against the constraints [N s/m]
  Felt delay;               ///< from a command to its wrench at the handle [s]
  /// Most poses of the session have freedoms that the hand does not reach, and forces along them
  /// that it does not feel: nothing is fitted.
  bool unreached = false;
  double noise = 0;                   ///< of the force sent: RMS of what is new in every tick [N]
  double largest_change = 0;          ///< of the force sent, from a tick to the next [N]
  static constexpr int kCauses = 16;  ///< room for every ForceOff
  std::array<std::uint64_t, kCauses> off{};           ///< ticks without force, by ForceOff
  std::array<std::uint64_t, kSafetyStages> stages{};  ///< ticks in which each changed the force

  std::string Text() const;     ///< figures, each beside what was promised
  std::string Verdict() const;  ///< a sentence
};

}  // namespace vmech
