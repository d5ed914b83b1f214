#pragma once

#include "vmech/mechanisms/mechanism.h"

namespace vmech {

/// Generalised force of a freedom's spring and damper [N] or [N m]: -k (q - rest) - c v.
template <typename T>
T SpringForce(const PassiveOf<T>& passive, const T& position, const T& rate) {
  return -passive.stiffness * (position - passive.rest) - passive.viscous * rate;
}

/// True if the joint has dry friction, constant or in proportion to its load.
bool HasDryFriction(const Joint& joint);
/// True if any joint has springs or friction of any kind.
bool HasPassiveJoints(const Mechanism& mechanism);
/// True if any joint has dry friction.
bool HasDryFriction(const Mechanism& mechanism);
/// True if the friction of any joint depends on its load.
bool HasLoadFriction(const Mechanism& mechanism);

}  // namespace vmech
