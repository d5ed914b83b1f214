#include "vmech/dynamics/passive.h"

#include <algorithm>
#include <cmath>

namespace vmech {
namespace {

bool IsTranslation(JointType type, int freedom) {
  switch (type) {
    case JointType::kPrismatic:
      return true;
    case JointType::kCylindrical:
      return freedom == 0;
    case JointType::kPlanar:
      return freedom < 2;
    default:
      return false;
  }
}

}  // namespace

double PassiveForce(const Passive& passive, double dry_friction, double position, double rate) {
  const double direction = rate > 0 ? 1.0 : rate < 0 ? -1.0 : 0.0;
  return -passive.stiffness * (position - passive.rest) - passive.viscous * rate -
         dry_friction * direction;
}

bool HasPassive(const Mechanism& mechanism) {
  return std::any_of(mechanism.joints.begin(), mechanism.joints.end(), [](const Joint& joint) {
    if (joint.load_friction.coefficient != 0) return true;
    return std::any_of(joint.passive.begin(), joint.passive.end(), [](const Passive& p) {
      return p.stiffness != 0 || p.viscous != 0 || p.coulomb != 0;
    });
  });
}

bool HasLoadFriction(const Mechanism& mechanism) {
  return std::any_of(mechanism.joints.begin(), mechanism.joints.end(),
                     [](const Joint& joint) { return joint.load_friction.coefficient != 0; });
}

double DryFriction(const Joint& joint, int freedom, const Wrenchd& W_F) {
  const LoadFriction& friction = joint.load_friction;
  double force = joint.passive[freedom].coulomb;
  if (friction.coefficient == 0) return force;
  // The load across the freedom's own direction; all of it where the joint has no axis.
  const bool has_axis = joint.type != JointType::kSpherical && joint.type != JointType::kUniversal;
  const double across = has_axis && joint.type != JointType::kPlanar
                            ? std::hypot(W_F.force.x(), W_F.force.y())
                        : joint.type == JointType::kPlanar ? std::abs(W_F.force.z())
                                                           : W_F.force.norm();
  const double lever = IsTranslation(joint.type, freedom) ? 1.0 : friction.radius;
  return force + friction.coefficient * lever * across;
}

}  // namespace vmech
