#include "vmech/dynamics/loads/pose/contact_friction.h"

#include <algorithm>
#include <cmath>

#include "vmech/base/dual.h"
#include "vmech/base/lanes4.h"
#include "vmech/base/tape/taped4.h"

namespace vmech {
namespace {

/// 1 - mu t may not come nearer to zero than this; ThreadLocks says where it does.
constexpr double kSteepest = 1e-9;

template <typename T>
T Norm(const Vector3<T>& v) {
  using std::sqrt;
  return sqrt(v.squaredNorm());
}

template <typename T>
Vector3<T> Across(const Vector3<T>& axis, const Vector3<T>& v) {
  return v - axis * axis.dot(v);
}

/// Is a length of the contact not given? It is the same in all lanes.
template <typename T>
bool IsZero(const T& length) {
  return Lane(length, 0) == 0;
}

/// S(a): the load of the supports across the axis.
template <typename T>
T SupportLoad(const Vector3<T>& axis, const Wrench<T>& W, const T& length) {
  const Vector3<T> across = Across(axis, W.force);
  if (IsZero(length)) return Norm(across);
  const Vector3<T> half = T(0.5) * across, couple = axis.cross(W.moment) * (T(1) / length);
  return Norm<T>(half + couple) + Norm<T>(half - couple);
}

/// A pin with collars: mu (r S(a) + r_t |F.a|).
template <typename T>
T PinLimit(const LoadFrictionOf<T>& friction, const Vector3<T>& axis, const Wrench<T>& W) {
  using std::abs;
  return friction.coefficient * (friction.radius * SupportLoad(axis, W, friction.length) +
                                 friction.thrust_radius * abs(axis.dot(W.force)));
}

/// The second axis of a universal joint: y of the second anchor, axes of the first.
template <typename T>
Vector3<T> SecondPin(const T& first_angle) {
  T sine, cosine;
  SinCos(first_angle, &sine, &cosine);
  return {T(0), cosine, sine};
}

template <typename T>
T ThreadLimit(const typename Design<T>::JointNumbers& numbers, const Wrench<T>& W, const T& rate) {
  using std::abs, std::max;
  const LoadFrictionOf<T>& friction = numbers.load_friction;
  const T slope = abs(numbers.pitch) / friction.radius;
  const T raising = W.force.z() * (numbers.pitch * rate), zero(0);
  const T sense = Select(raising > zero, T(1), Select(raising < zero, T(-1), zero));
  const T steepness = max(T(1) - friction.coefficient * slope * sense, T(kSteepest));
  return friction.coefficient * friction.radius * (T(1) + slope * slope) * abs(W.force.z()) /
         steepness;
}

/// What the load adds to the limits.
template <typename T>
Vector3<T> LoadLimits(JointType type, const typename Design<T>::JointNumbers& numbers,
                      const Wrench<T>& W, const Vector3<T>& position, const Vector3<T>& rate) {
  using std::abs;
  const LoadFrictionOf<T>& friction = numbers.load_friction;
  const T mu = friction.coefficient, zero(0);
  const Vector3<T> x = Vector3<T>::UnitX(), z = Vector3<T>::UnitZ();
  switch (type) {
    case JointType::kRevolute:
      return {PinLimit(friction, z, W), zero, zero};
    case JointType::kPrismatic: {
      const T sides = IsZero(friction.width) ? zero : T(2) / friction.width * abs(W.moment.z());
      return {mu * (SupportLoad(z, W, friction.length) + sides), zero, zero};
    }
    case JointType::kCylindrical: {
      const T force = mu * SupportLoad(z, W, friction.length);
      return {force, friction.radius * force, zero};
    }
    case JointType::kScrew: {
      const T radial = mu * friction.radius * SupportLoad(z, W, friction.length);
      return {radial + ThreadLimit(numbers, W, rate[0]), zero, zero};
    }
    case JointType::kUniversal:
      return {PinLimit(friction, x, W), PinLimit(friction, SecondPin(position[0]), W), zero};
    case JointType::kSpherical:
      return Vector3<T>::Constant(mu * friction.radius * Norm(W.force));
    case JointType::kPlanar: {
      const T force = mu * abs(W.force.z());
      return {force, force, friction.radius * force};
    }
    case JointType::kWeld:
      break;
  }
  return Vector3<T>::Zero();
}

bool IsShift(JointType type, int freedom) {
  return type == JointType::kPrismatic || (type == JointType::kCylindrical && freedom == 0) ||
         (type == JointType::kPlanar && freedom < 2);
}

}  // namespace

SlidingContacts ContactsOf(JointType type) {
  if (type == JointType::kWeld) return {};
  if (type == JointType::kUniversal) return {2, {{{0, 1}, {1, 1}}}};
  return {1, {{{0, FreedomsOf(type)}, {}}}};
}

template <typename T>
Vector3<T> FrictionLimits(JointType type, const typename Design<T>::JointNumbers& numbers,
                          const Wrench<T>& W_F, const Vector3<T>& position,
                          const Vector3<T>& rate) {
  Vector3<T> limits = Vector3<T>::Zero();
  if (!IsZero(numbers.load_friction.coefficient)) {
    limits = LoadLimits(type, numbers, W_F, position, rate);
  }
  for (int i = 0; i < 3; ++i) limits[i] += numbers.passive[i].coulomb;
  return limits;
}

Vector3d FrictionLimits(const Joint& joint, const Wrenchd& W_F, const Vector3d& position,
                        const Vector3d& rate) {
  return FrictionLimits<double>(joint.type, NumbersOf(joint), W_F, position, rate);
}

template <typename T>
Vector3<T> SlidingRates(JointType type, const Vector3<T>& rate, double slowest, double length) {
  Vector3<T> sliding = Vector3<T>::Zero();
  for (const SlidingContact& contact : ContactsOf(type)) {
    T square(0);
    for (int i = contact.first; i < contact.first + contact.count; ++i) {
      const T speed = IsShift(type, i) ? T(rate[i] * (1 / length)) : rate[i];
      square += speed * speed;
    }
    for (int i = contact.first; i < contact.first + contact.count; ++i) {
      sliding[i] = Select(square > T(slowest * slowest), rate[i], T(0));
    }
  }
  return sliding;
}

template <typename T>
Vector3<T> SlidingFriction(JointType type, const Vector3<T>& limits, const Vector3<T>& rate) {
  using std::sqrt;
  Vector3<T> friction = Vector3<T>::Zero();
  for (const SlidingContact& contact : ContactsOf(type)) {
    T square(0);
    for (int i = contact.first; i < contact.first + contact.count; ++i) {
      square += limits[i] * limits[i] * rate[i] * rate[i];
    }
    const T power = sqrt(square);
    const T share = Select(power > T(0), T(1) / power, T(0));
    for (int i = contact.first; i < contact.first + contact.count; ++i) {
      friction[i] = -limits[i] * limits[i] * rate[i] * share;
    }
  }
  return friction;
}

bool ThreadLocks(const Joint& joint, const Wrenchd& W_F, double rate) {
  const LoadFriction& friction = joint.load_friction;
  if (joint.type != JointType::kScrew || friction.coefficient == 0) return false;
  return W_F.force.z() * joint.pitch * rate > 0 &&
         friction.coefficient * std::abs(joint.pitch) >= friction.radius * (1 - kSteepest);
}

bool IsSelfLocking(const Joint& joint) {
  const LoadFriction& friction = joint.load_friction;
  return joint.type == JointType::kScrew && friction.coefficient > 0 &&
         friction.coefficient * friction.radius >= std::abs(joint.pitch);
}

std::array<UnaccountedLoad, 2> UnaccountedLoads(const Joint& joint, const Wrenchd& W_F,
                                                const Vector3d& position) {
  const LoadFriction& friction = joint.load_friction;
  UnaccountedLoad thrust{"thrust", "N", "thrust_radius", 0};
  UnaccountedLoad couple{"tilting couple", "N m", "length", 0};
  UnaccountedLoad torque{"torque about the slide", "N m", "width", 0};
  if (friction.coefficient == 0) return {};
  const double tilt = W_F.moment.head<2>().norm();
  switch (joint.type) {
    case JointType::kUniversal: {
      const Vector3d x = Vector3d::UnitX(), y = SecondPin(position[0]);
      thrust.size = std::max(std::abs(x.dot(W_F.force)), std::abs(y.dot(W_F.force)));
      couple.size = std::max(Across(x, W_F.moment).norm(), Across(y, W_F.moment).norm());
      break;
    }
    case JointType::kRevolute:
      thrust.size = std::abs(W_F.force.z());
      couple.size = tilt;
      break;
    case JointType::kPrismatic:
      couple.size = tilt;
      torque.size = std::abs(W_F.moment.z());
      break;
    case JointType::kCylindrical:
    case JointType::kScrew:
      couple.size = tilt;
      break;
    case JointType::kPlanar:
      // The pressure moves to the side of the couple, and stays inside the contact up to here.
      couple.size = tilt > friction.radius * std::abs(W_F.force.z()) ? tilt : 0;
      couple.key = nullptr;
      break;
    default:
      return {};
  }
  if (friction.length > 0) couple.size = 0;
  if (friction.thrust_radius > 0) thrust.size = 0;
  if (friction.width > 0) torque.size = 0;
  return {couple, joint.type == JointType::kPrismatic ? torque : thrust};
}

// NOLINTBEGIN(bugprone-macro-parentheses): T is a type
#define VMECH_INSTANTIATE(T)                                                                     \
  template Vector3<T> FrictionLimits<T>(JointType, const typename Design<T>::JointNumbers&,      \
                                        const Wrench<T>&, const Vector3<T>&, const Vector3<T>&); \
  template Vector3<T> SlidingRates<T>(JointType, const Vector3<T>&, double, double);             \
  template Vector3<T> SlidingFriction<T>(JointType, const Vector3<T>&, const Vector3<T>&);
VMECH_INSTANTIATE(double)
VMECH_INSTANTIATE(Dual)
VMECH_INSTANTIATE(Taped4)
VMECH_INSTANTIATE(Lanes4)
#undef VMECH_INSTANTIATE
// NOLINTEND(bugprone-macro-parentheses)

}  // namespace vmech
