#include "vmech/dynamics/rigid_body/passive.h"

#include <algorithm>

namespace vmech {

bool HasDryFriction(const Joint& joint) {
  return joint.load_friction.coefficient != 0 ||
         std::any_of(joint.passive.begin(), joint.passive.end(),
                     [](const Passive& p) { return p.coulomb != 0; });
}

bool HasPassiveJoints(const Mechanism& mechanism) {
  return std::any_of(mechanism.joints.begin(), mechanism.joints.end(), [](const Joint& joint) {
    if (HasDryFriction(joint)) return true;
    return std::any_of(joint.passive.begin(), joint.passive.end(),
                       [](const Passive& p) { return p.stiffness != 0 || p.viscous != 0; });
  });
}

bool HasDryFriction(const Mechanism& mechanism) {
  return std::any_of(mechanism.joints.begin(), mechanism.joints.end(),
                     [](const Joint& joint) { return HasDryFriction(joint); });
}

bool HasLoadFriction(const Mechanism& mechanism) {
  return std::any_of(mechanism.joints.begin(), mechanism.joints.end(),
                     [](const Joint& joint) { return joint.load_friction.coefficient != 0; });
}

}  // namespace vmech
