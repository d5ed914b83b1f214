#include "vmech/dynamics/passive.h"

#include <algorithm>
#include <cmath>

#include "vmech/kinematics/packet.h"

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

template <typename T>
T PassiveForce(const Passive& passive, const T& dry_friction, const T& position, const T& rate) {
  const T zero(0);
  const T direction = Select(rate > zero, T(1), Select(rate < zero, T(-1), zero));
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

template <typename T>
T DryFriction(const Joint& joint, int freedom, const Wrench<T>& W_F) {
  using std::abs;
  using std::sqrt;
  const LoadFriction& friction = joint.load_friction;
  const T constant(joint.passive[freedom].coulomb);
  if (friction.coefficient == 0) return constant;
  const Vector3<T>& f = W_F.force;
  T across;  // the load across the freedom's own direction; all of it where the joint has no axis
  switch (joint.type) {
    case JointType::kSpherical:
    case JointType::kUniversal:
      across = sqrt(f.squaredNorm());
      break;
    case JointType::kPlanar:
      across = abs(f.z());
      break;
    default:
      across = sqrt(f.x() * f.x() + f.y() * f.y());
  }
  const double lever = IsTranslation(joint.type, freedom) ? 1.0 : friction.radius;
  return constant + friction.coefficient * lever * across;
}

// NOLINTBEGIN(bugprone-macro-parentheses): T is a type
#define VMECH_INSTANTIATE(T)                                                \
  template T PassiveForce<T>(const Passive&, const T&, const T&, const T&); \
  template T DryFriction<T>(const Joint&, int, const Wrench<T>&);
VMECH_INSTANTIATE(double)
VMECH_INSTANTIATE(Packet)
#undef VMECH_INSTANTIATE
// NOLINTEND(bugprone-macro-parentheses)

}  // namespace vmech
