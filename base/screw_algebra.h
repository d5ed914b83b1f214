#pragma once

#include <cmath>
#include <cstring>

#include "vmech/base/pose.h"
#include "vmech/base/screw.h"

namespace vmech {

// Functions of a few instructions each, which keep the last number of a vector zero. How a Four is
// passed depends on the instruction set: for the sources of the library alone.

/// The last number becomes zero: by a mask, for which compilers find one instruction.
inline Four FirstThree(const Four& a) noexcept {
  using Bits = long long __attribute__((vector_size(32)));
  return reinterpret_cast<Four>(reinterpret_cast<Bits>(a) & Bits{-1, -1, -1, 0});
}
inline Four FourOf(const Vector3d& a) noexcept {
  return FirstThree(Four{a[0], a[1], a[2], a[2]});
}
inline Vector3d Vector3Of(const Four& a) noexcept {
  return {a[0], a[1], a[2]};
}

inline Four Cross(const Four& a, const Four& b) noexcept {
  const Four a_yzx = __builtin_shufflevector(a, a, 1, 2, 0, 3);
  const Four b_yzx = __builtin_shufflevector(b, b, 1, 2, 0, 3);
  const Four zxy = a * b_yzx - a_yzx * b;
  return __builtin_shufflevector(zxy, zxy, 1, 2, 0, 3);
}
inline double Dot(const Four& a, const Four& b) noexcept {
  const Four ab = a * b;
  return (ab[0] + ab[2]) + ab[1];
}
inline double Length(const Four& a) noexcept {
  return std::sqrt(Dot(a, a));
}

/// R a.
inline Four Turned(const Axes& X, double a0, double a1, double a2) noexcept {
  return a0 * X.x + a1 * X.y + a2 * X.z;
}
inline Four Turned(const Axes& X, const Vector3d& a) noexcept {
  return Turned(X, a[0], a[1], a[2]);
}
inline Four Turned(const Axes& X, const Four& a) noexcept {
  return Turned(X, a[0], a[1], a[2]);
}
/// R'a.
inline Four InverseRotate(const Axes& X, const Four& a) noexcept {
  const Four x = X.x * a, y = X.y * a, z = X.z * a, zero{};
  // By halves of registers: one instruction each.
  const auto sums = [](const Four& a, const Four& b) {
    return __builtin_shufflevector(a, b, 0, 4, 2, 6) + __builtin_shufflevector(a, b, 1, 5, 3, 7);
  };
  const Four xy = sums(x, y), z0 = sums(z, zero);
  return __builtin_shufflevector(xy, z0, 0, 1, 4, 5) + __builtin_shufflevector(xy, z0, 2, 3, 6, 7);
}
/// R A.
inline Axes Turned(const Axes& X, const Matrix3d& A, const Four& p) noexcept {
  return {Turned(X, A.col(0)), Turned(X, A.col(1)), Turned(X, A.col(2)), p};
}
/// X_WB p_B.
inline Four PointInWorld(const Axes& X, const Vector3d& p) noexcept {
  return X.p + Turned(X, p);
}
inline Four PointInWorld(const Axes& X, const Four& p) noexcept {
  return X.p + Turned(X, p);
}
/// X_WB X_BC.
inline Axes operator*(const Axes& X, const Axes& Y) noexcept {
  return {Turned(X, Y.x), Turned(X, Y.y), Turned(X, Y.z), X.p + Turned(X, Y.p)};
}
inline Axes operator*(const Axes& X, const Posed& Y) noexcept {
  return Turned(X, Y.R, PointInWorld(X, Y.p));
}
inline Axes AxesOf(const Posed& X) noexcept {
  // R and p as the twelve numbers that they are: whole registers, one number too many in each.
  static_assert(sizeof(X) == 12 * sizeof(double));
  const auto from = [&](int i) {
    Four four;
    std::memcpy(&four, reinterpret_cast<const char*>(&X) + i * sizeof(double), sizeof(four));
    return four;
  };
  const Four p = from(8);
  return {FirstThree(from(0)), FirstThree(from(3)), FirstThree(from(6)),
          FirstThree(__builtin_shufflevector(p, p, 1, 2, 3, 0))};
}
inline Matrix3d RotationOf(const Axes& X) noexcept {
  Matrix3d R;
  // Each column's fourth number falls on the next column, which comes after it.
  std::memcpy(R.data(), &X.x, sizeof(Four));
  std::memcpy(R.data() + 3, &X.y, sizeof(Four));
  std::memcpy(R.data() + 6, &X.z, 3 * sizeof(double));
  return R;
}
inline Posed PoseOf(const Axes& X) noexcept {
  return {RotationOf(X), Vector3Of(X.p)};
}

inline Screw ScrewOf(const Vector6d& a) noexcept {
  return {FirstThree(Four{a[0], a[1], a[2], a[2]}), FirstThree(Four{a[3], a[4], a[5], a[5]})};
}
inline Vector6d Vector6Of(const Screw& a) noexcept {
  return {a.linear[0], a.linear[1], a.linear[2], a.angular[0], a.angular[1], a.angular[2]};
}

inline Screw& operator+=(Screw& a, const Screw& b) noexcept {
  a.linear += b.linear;
  a.angular += b.angular;
  return a;
}
inline Screw& operator-=(Screw& a, const Screw& b) noexcept {
  a.linear -= b.linear;
  a.angular -= b.angular;
  return a;
}
inline Screw operator+(const Screw& a, const Screw& b) noexcept {
  return {a.linear + b.linear, a.angular + b.angular};
}
inline Screw operator-(const Screw& a, const Screw& b) noexcept {
  return {a.linear - b.linear, a.angular - b.angular};
}
inline Screw operator*(double s, const Screw& a) noexcept {
  return {s * a.linear, s * a.angular};
}

/// Entry by entry: diag(gains) a.
inline Screw Scaled(const Screw& gains, const Screw& a) noexcept {
  return {gains.linear * a.linear, gains.angular * a.angular};
}

/// The power of a wrench on a twist.
inline double Power(const Screw& wrench, const Screw& twist) noexcept {
  const Four power = wrench.linear * twist.linear + wrench.angular * twist.angular;
  return (power[0] + power[2]) + power[1];
}
/// The velocity of a point Q that moves with a twist.
inline Four VelocityAt(const Four& p_WQ, const Screw& twist) noexcept {
  return twist.linear + Cross(twist.angular, p_WQ);
}
/// A wrench that is given about a point Q.
inline Screw WrenchAt(const Four& p_WQ, const Four& force, const Four& moment) noexcept {
  return {force, moment + Cross(p_WQ, force)};
}
/// The rate at which a twist U changes that is carried along by a twist V.
inline Screw CarriedTwist(const Screw& V, const Screw& U) noexcept {
  return {Cross(V.angular, U.linear) + Cross(V.linear, U.angular), Cross(V.angular, U.angular)};
}
/// The rate at which a wrench or a momentum changes that is carried along by a twist V.
inline Screw CarriedWrench(const Screw& V, const Screw& F) noexcept {
  return {Cross(V.angular, F.linear), Cross(V.angular, F.angular) + Cross(V.linear, F.linear)};
}

inline ScrewInertia& operator+=(ScrewInertia& a, const ScrewInertia& b) noexcept {
  a.mass += b.mass;
  a.moment += b.moment;
  a.Ix += b.Ix;
  a.Iy += b.Iy;
  a.Iz += b.Iz;
  return a;
}
/// The momentum at a twist.
inline Screw operator*(const ScrewInertia& I, const Screw& V) noexcept {
  const Four& w = V.angular;
  return {I.mass * V.linear + Cross(w, I.moment),
          w[0] * I.Ix + w[1] * I.Iy + w[2] * I.Iz + Cross(I.moment, V.linear)};
}

}  // namespace vmech
