#pragma once

#include "vmech/dynamics/reactions.h"
#include "vmech/kinematics/tree_workspace.h"
#include "vmech/mechanisms/mechanism.h"

namespace vmech {

/// Generalised force of a freedom's spring and friction: -k (q - rest) - c v - f sign(v), where f
/// is the constant dry friction and what LoadFriction adds. Dry friction is zero at rest.
template <typename T>
T PassiveForce(const Passive& passive, const T& dry_friction, const T& position, const T& rate);

/// Does any joint have springs or friction?
bool HasPassive(const Mechanism& mechanism);
/// Does any joint's friction depend on its load?
bool HasLoadFriction(const Mechanism& mechanism);

/// Dry friction of one freedom of a joint that carries W_F, about M in axes of F.
template <typename T>
T DryFriction(const Joint& joint, int freedom, const Wrench<T>& W_F);

}  // namespace vmech
