#pragma once

#include <cmath>
#include <cstring>
#include <type_traits>

#include "vmech/base/screw.h"

namespace vmech {

// Functions of a few instructions each, which keep the last number of a Double4 zero. How a Double4
// is passed depends on the instruction set: for the sources of the library alone.

/// The last number becomes zero: by a mask, for which compilers find one instruction.
inline Double4 FirstThree(const Double4& a) noexcept {
  using Bits = long long __attribute__((vector_size(32)));
  return reinterpret_cast<Double4>(reinterpret_cast<Bits>(a) & Bits{-1, -1, -1, 0});
}
inline Double4 Double4Of(const Vector3d& a) noexcept {
  return FirstThree(Double4{a[0], a[1], a[2], a[2]});
}
inline Vector3d Vector3Of(const Double4& a) noexcept {
  return {a[0], a[1], a[2]};
}
template <typename T>
inline const Vector3<T>& Vector3Of(const Vector3<T>& a) noexcept {
  return a;
}
template <typename T>
inline Triple<T> ZeroTriple() noexcept {
  if constexpr (std::is_same_v<T, double>) {
    return Double4{};
  } else {
    return Vector3<T>::Zero();
  }
}
/// As the kernels of number T take it.
template <typename T>
inline Triple<T> TripleOf(const std::type_identity_t<Vector3<T>>& a) noexcept {
  if constexpr (std::is_same_v<T, double>) {
    return Double4Of(a);
  } else {
    return a;
  }
}
template <typename T>
inline Triple<T> TripleOf(const T& x, const T& y, const T& z) noexcept {
  if constexpr (std::is_same_v<T, double>) {
    return Double4{x, y, z, 0};
  } else {
    return {x, y, z};
  }
}

inline Double4 Cross(const Double4& a, const Double4& b) noexcept {
  const Double4 a_yzx = __builtin_shufflevector(a, a, 1, 2, 0, 3);
  const Double4 b_yzx = __builtin_shufflevector(b, b, 1, 2, 0, 3);
  const Double4 zxy = a * b_yzx - a_yzx * b;
  return __builtin_shufflevector(zxy, zxy, 1, 2, 0, 3);
}
template <typename A, typename B>
inline Vector3<typename A::Scalar> Cross(const Eigen::MatrixBase<A>& a,
                                         const Eigen::MatrixBase<B>& b) {
  return a.cross(b);
}
inline double Dot(const Double4& a, const Double4& b) noexcept {
  const Double4 ab = a * b;
  return (ab[0] + ab[2]) + ab[1];
}
template <typename A, typename B>
inline typename A::Scalar Dot(const Eigen::MatrixBase<A>& a, const Eigen::MatrixBase<B>& b) {
  return a.dot(b);
}
inline double Length(const Double4& a) noexcept {
  return std::sqrt(Dot(a, a));
}

/// R a.
template <typename T>
inline Triple<T> Rotate(const FrameT<T>& X, const T& a0, const T& a1, const T& a2) noexcept {
  return a0 * X.x + a1 * X.y + a2 * X.z;
}
template <typename T>
inline Triple<T> Rotate(const FrameT<T>& X, const std::type_identity_t<Triple<T>>& a) noexcept {
  return a[0] * X.x + a[1] * X.y + a[2] * X.z;
}
inline Double4 Rotate(const Frame& X, const Vector3d& a) noexcept {
  return Rotate(X, a[0], a[1], a[2]);
}
/// R'a.
inline Double4 InverseRotate(const Frame& X, const Double4& a) noexcept {
  const Double4 x = X.x * a, y = X.y * a, z = X.z * a, zero{};
  // By halves of registers: one instruction each.
  const auto sums = [](const Double4& a, const Double4& b) {
    return __builtin_shufflevector(a, b, 0, 4, 2, 6) + __builtin_shufflevector(a, b, 1, 5, 3, 7);
  };
  const Double4 xy = sums(x, y), z0 = sums(z, zero);
  return __builtin_shufflevector(xy, z0, 0, 1, 4, 5) + __builtin_shufflevector(xy, z0, 2, 3, 6, 7);
}
template <typename T>
inline Vector3<T> InverseRotate(const FrameT<T>& X,
                                const std::type_identity_t<Vector3<T>>& a) noexcept {
  return {X.x.dot(a), X.y.dot(a), X.z.dot(a)};
}
/// R A.
template <typename T>
inline FrameT<T> Rotate(const FrameT<T>& X, const Matrix3<T>& A, const Triple<T>& p) noexcept {
  return {Rotate(X, A(0, 0), A(1, 0), A(2, 0)), Rotate(X, A(0, 1), A(1, 1), A(2, 1)),
          Rotate(X, A(0, 2), A(1, 2), A(2, 2)), p};
}
/// X_WB p_B.
template <typename T>
inline Triple<T> PointInWorld(const FrameT<T>& X,
                              const std::type_identity_t<Triple<T>>& p) noexcept {
  return X.p + Rotate(X, p);
}
inline Double4 PointInWorld(const Frame& X, const Vector3d& p) noexcept {
  return X.p + Rotate(X, p);
}
/// X_WB X_BC.
template <typename T>
inline FrameT<T> operator*(const FrameT<T>& X, const FrameT<T>& Y) noexcept {
  return {Rotate(X, Y.x), Rotate(X, Y.y), Rotate(X, Y.z), X.p + Rotate(X, Y.p)};
}
inline Frame operator*(const Frame& X, const Posed& Y) noexcept {
  return Rotate(X, Y.R, PointInWorld(X, Y.p));
}
inline Frame FrameOf(const Posed& X) noexcept {
  // R and p as the twelve numbers that they are: whole registers, one number too many in each.
  static_assert(sizeof(X) == 12 * sizeof(double));
  const auto from = [&](int i) {
    Double4 four;
    std::memcpy(&four, reinterpret_cast<const char*>(&X) + i * sizeof(double), sizeof(four));
    return four;
  };
  const Double4 p = from(8);
  return {FirstThree(from(0)), FirstThree(from(3)), FirstThree(from(6)),
          FirstThree(__builtin_shufflevector(p, p, 1, 2, 3, 0))};
}
template <typename T>
inline FrameT<T> FrameOf(const Pose<T>& X) noexcept {
  return {X.R.col(0), X.R.col(1), X.R.col(2), X.p};
}
inline Matrix3d RotationOf(const Frame& X) noexcept {
  Matrix3d R;
  // Each column's fourth number falls on the next column, which comes after it.
  std::memcpy(R.data(), &X.x, sizeof(Double4));
  std::memcpy(R.data() + 3, &X.y, sizeof(Double4));
  std::memcpy(R.data() + 6, &X.z, 3 * sizeof(double));
  return R;
}
template <typename T>
inline Matrix3<T> RotationOf(const FrameT<T>& X) noexcept {
  Matrix3<T> R;
  R << X.x, X.y, X.z;
  return R;
}
template <typename T>
inline Pose<T> PoseOf(const FrameT<T>& X) noexcept {
  return {RotationOf(X), Vector3Of(X.p)};
}

inline Screw ScrewOf(const Vector6d& a) noexcept {
  return {FirstThree(Double4{a[0], a[1], a[2], a[2]}), FirstThree(Double4{a[3], a[4], a[5], a[5]})};
}
template <typename T>
inline Vector6<T> Vector6Of(const ScrewT<T>& a) noexcept {
  return {a.linear[0], a.linear[1], a.linear[2], a.angular[0], a.angular[1], a.angular[2]};
}

template <typename T>
inline ScrewT<T>& operator+=(ScrewT<T>& a, const ScrewT<T>& b) noexcept {
  a.linear += b.linear;
  a.angular += b.angular;
  return a;
}
template <typename T>
inline ScrewT<T>& operator-=(ScrewT<T>& a, const ScrewT<T>& b) noexcept {
  a.linear -= b.linear;
  a.angular -= b.angular;
  return a;
}
template <typename T>
inline ScrewT<T> operator+(const ScrewT<T>& a, const ScrewT<T>& b) noexcept {
  return {a.linear + b.linear, a.angular + b.angular};
}
template <typename T>
inline ScrewT<T> operator-(const ScrewT<T>& a, const ScrewT<T>& b) noexcept {
  return {a.linear - b.linear, a.angular - b.angular};
}
template <typename T>
inline ScrewT<T> operator*(const std::type_identity_t<T>& s, const ScrewT<T>& a) noexcept {
  return {s * a.linear, s * a.angular};
}

/// Entry by entry: diag(gains) a.
inline Screw Scaled(const Screw& gains, const Screw& a) noexcept {
  return {gains.linear * a.linear, gains.angular * a.angular};
}

/// The power of a wrench on a twist.
inline double Power(const Screw& wrench, const Screw& twist) noexcept {
  const Double4 power = wrench.linear * twist.linear + wrench.angular * twist.angular;
  return (power[0] + power[2]) + power[1];
}
template <typename T>
inline T Power(const ScrewT<T>& wrench, const ScrewT<T>& twist) noexcept {
  return Dot(wrench.linear, twist.linear) + Dot(wrench.angular, twist.angular);
}
/// The velocity of a point Q that moves with a twist.
template <typename T>
inline Triple<T> VelocityAt(const std::type_identity_t<Triple<T>>& p_WQ,
                            const ScrewT<T>& twist) noexcept {
  return twist.linear + Cross(twist.angular, p_WQ);
}
/// A wrench that is given about a point Q.
inline Screw WrenchAt(const Double4& p_WQ, const Double4& force, const Double4& moment) noexcept {
  return {force, moment + Cross(p_WQ, force)};
}
template <typename T>
inline ScrewT<T> WrenchAt(const Vector3<T>& p_WQ, const std::type_identity_t<Vector3<T>>& force,
                          const std::type_identity_t<Vector3<T>>& moment) noexcept {
  return {force, moment + Cross(p_WQ, force)};
}
/// A wrench about the origin and in the axes of X.
template <typename T>
inline Wrench<T> WrenchIn(const FrameT<T>& X, const ScrewT<T>& W) noexcept {
  const Triple<T> moment = W.angular - Cross(X.p, W.linear);
  return {Vector3Of(InverseRotate(X, W.linear)), Vector3Of(InverseRotate(X, moment))};
}
/// One that is given there.
template <typename T>
inline ScrewT<T> WrenchFrom(const FrameT<T>& X, const Wrench<T>& W) noexcept {
  return WrenchAt(X.p, Rotate(X, W.force[0], W.force[1], W.force[2]),
                  Rotate(X, W.moment[0], W.moment[1], W.moment[2]));
}
/// The rate at which a twist U changes that is carried along by a twist V.
template <typename T>
inline ScrewT<T> CarriedTwist(const ScrewT<T>& V, const ScrewT<T>& U) noexcept {
  return {Cross(V.angular, U.linear) + Cross(V.linear, U.angular), Cross(V.angular, U.angular)};
}
/// The rate at which a wrench or a momentum changes that is carried along by a twist V.
template <typename T>
inline ScrewT<T> CarriedWrench(const ScrewT<T>& V, const ScrewT<T>& F) noexcept {
  return {Cross(V.angular, F.linear), Cross(V.angular, F.angular) + Cross(V.linear, F.linear)};
}

template <typename T>
inline ScrewInertiaT<T>& operator+=(ScrewInertiaT<T>& a, const ScrewInertiaT<T>& b) noexcept {
  a.mass += b.mass;
  a.moment += b.moment;
  a.Ix += b.Ix;
  a.Iy += b.Iy;
  a.Iz += b.Iz;
  return a;
}
/// The momentum at a twist.
template <typename T>
inline ScrewT<T> operator*(const ScrewInertiaT<T>& I, const ScrewT<T>& V) noexcept {
  const Triple<T>& w = V.angular;
  return {I.mass * V.linear + Cross(w, I.moment),
          w[0] * I.Ix + w[1] * I.Iy + w[2] * I.Iz + Cross(I.moment, V.linear)};
}

}  // namespace vmech
