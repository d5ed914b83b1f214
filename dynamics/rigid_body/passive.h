#pragma once

#include "vmech/mechanisms/mechanism.h"

namespace vmech {

/// Generalised force of a freedom's spring and damper: -k (q - rest) - c v.
template <typename T>
T SpringForce(const PassiveOf<T>& passive, const T& position, const T& rate) {
  return -passive.stiffness * (position - passive.rest) - passive.viscous * rate;
}

/// Does the joint have dry friction, constant or in proportion to its load?
bool HasDryFriction(const Joint& joint);
/// Does any joint have springs or friction?
bool HasPassiveJoints(const Mechanism& mechanism);
/// Does any joint have dry friction?
bool HasDryFriction(const Mechanism& mechanism);
/// Does any joint's friction depend on its load?
bool HasLoadFriction(const Mechanism& mechanism);

}  // namespace vmech
