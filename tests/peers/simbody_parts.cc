#include "simbody_parts.h"

#include <array>
#include <stdexcept>

namespace vmech::peers {

using SimTK::MobilizedBody;
using SimTK::SpatialVec;
using SimTK::Transform;
using SimTK::Vec3;

Vec3 ToSimTK(const Vector3d& v) {
  return Vec3(v.x(), v.y(), v.z());
}

Transform ToSimTK(const Posed& X) {
  SimTK::Mat33 R;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) R(i, j) = X.R(i, j);
  }
  return Transform(SimTK::Rotation(R, true), ToSimTK(X.p));
}

SpatialVec ToSimTK(const Wrenchd& w) {
  return SpatialVec(ToSimTK(w.moment), ToSimTK(w.force));
}

Vector3d FromSimTK(const Vec3& v) {
  return Vector3d(v[0], v[1], v[2]);
}

Wrenchd FromSimTK(const SpatialVec& w) {
  return {FromSimTK(w[1]), FromSimTK(w[0])};
}

SimTK::MassProperties ToSimTK(const MassProperties& m) {
  const Matrix3d& I = m.I_Lcm;
  const SimTK::Inertia central(Vec3(I(0, 0), I(1, 1), I(2, 2)), Vec3(I(0, 1), I(0, 2), I(1, 2)));
  const Vec3 com = ToSimTK(m.p_LoLcm);
  return SimTK::MassProperties(m.mass, com, central.shiftFromMassCenter(-com, m.mass));
}

Posed FromSimTK(const Transform& X) {
  Posed pose;
  for (int i = 0; i < 3; ++i) pose.R.col(i) = FromSimTK(Vec3(X.R()(i)));
  pose.p = FromSimTK(X.p());
  return pose;
}

Posed FrameForSimbody(JointType type, const Posed& X_LA) {
  if (type != JointType::kPrismatic) return X_LA;
  Matrix3d x_is_z;
  x_is_z << 0, 1, 0, 0, 0, 1, 1, 0, 0;
  return X_LA * Posed{x_is_z, Vector3d::Zero()};
}

SimTK::MobilizerUIndex SpeedIndex(JointType type, int freedom) {
  constexpr std::array<int, 3> kPlanar{1, 2, 0};
  if (type == JointType::kPlanar) return SimTK::MobilizerUIndex(kPlanar[freedom]);
  if (type == JointType::kCylindrical) return SimTK::MobilizerUIndex(1 - freedom);
  return SimTK::MobilizerUIndex(freedom);
}

MobilizedBody AddMobilizer(const Joint& joint, MobilizedBody& parent, const Transform& inboard,
                           const SimTK::Body& body, const Transform& outboard,
                           MobilizedBody::Direction direction) {
  switch (joint.type) {
    case JointType::kRevolute:
      return MobilizedBody::Pin(parent, inboard, body, outboard, direction);
    case JointType::kPrismatic:
      return MobilizedBody::Slider(parent, inboard, body, outboard, direction);
    case JointType::kCylindrical:
      return MobilizedBody::Cylinder(parent, inboard, body, outboard, direction);
    case JointType::kScrew:
      return MobilizedBody::Screw(parent, inboard, body, outboard, joint.pitch, direction);
    case JointType::kUniversal:
      return MobilizedBody::Universal(parent, inboard, body, outboard, direction);
    case JointType::kSpherical:
      return MobilizedBody::Ball(parent, inboard, body, outboard, direction);
    case JointType::kPlanar:
      return MobilizedBody::Planar(parent, inboard, body, outboard, direction);
    case JointType::kWeld:
      return MobilizedBody::Weld(parent, inboard, body, outboard);
  }
  throw std::invalid_argument("joint '" + joint.name + "' has an unknown type");
}

LoopEquations EquationsOf(JointType type) {
  switch (type) {
    case JointType::kRevolute:
      return {{0, 1, 2}, {{0, 2}, {1, 2}}};
    case JointType::kPrismatic:
      return {{0, 1}, {{0, 1}, {1, 2}, {2, 0}}};
    case JointType::kCylindrical:
      return {{0, 1}, {{0, 2}, {1, 2}}};
    case JointType::kUniversal:
      return {{0, 1, 2}, {{0, 1}}};
    case JointType::kSpherical:
      return {{0, 1, 2}, {}};
    case JointType::kPlanar:
      return {{2}, {{0, 2}, {1, 2}}};
    case JointType::kWeld:
      return {{0, 1, 2}, {{0, 1}, {1, 2}, {2, 0}}};
    case JointType::kScrew:
      break;
  }
  throw std::invalid_argument("a screw cannot close a loop here");
}

}  // namespace vmech::peers
