#pragma once

#include <Eigen/Geometry>

#include "vmech/base/eigen.h"

namespace vmech {

/// A vector of three numbers of type T.
template <typename T>
using Vector3 = Eigen::Matrix<T, 3, 1>;
/// A vector of six numbers of type T: [linear; angular] or [force; moment].
template <typename T>
using Vector6 = Eigen::Matrix<T, 6, 1>;
/// A 3 x 3 matrix of numbers of type T.
template <typename T>
using Matrix3 = Eigen::Matrix<T, 3, 3>;
/// A matrix of any size of numbers of type T.
template <typename T>
using MatrixX = Eigen::Matrix<T, Eigen::Dynamic, Eigen::Dynamic>;
/// A vector of any length of numbers of type T.
template <typename T>
using VectorX = Eigen::Matrix<T, Eigen::Dynamic, 1>;
using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;
/// Six doubles: [linear; angular] or [force; moment].
using Vector6d = Vector6<double>;
/// 6 x 6 doubles.
using Matrix6d = Eigen::Matrix<double, 6, 6>;

/// [a; b]; quicker than Eigen's comma, which looks for alignment.
template <typename T>
Vector6<T> Stacked(const Vector3<T>& a, const Vector3<T>& b) {
  return {a[0], a[1], a[2], b[0], b[1], b[2]};
}

/// The pose X_AB of a frame B in a frame A: p_A = R_AB p_B + p_AB. Lengths in metres.
/// Products chain, X_AC = X_AB * X_BC. T is the scalar.
template <typename T>
struct Pose {
  Matrix3<T> R = Matrix3<T>::Identity();  ///< R_AB: its columns are B's axes in A
  Vector3<T> p = Vector3<T>::Zero();      ///< p_AB: B's origin in A [m]

  Pose operator*(const Pose& X) const { return {R * X.R, R * X.p + p}; }  ///< X_AB X_BC = X_AC
  /// The point p_B as p_A [m].
  Vector3<T> operator*(const Vector3<T>& point) const { return R * point + p; }
  Pose inverse() const { return {R.transpose(), -(R.transpose() * p)}; }  ///< X_BA

  /// The same pose with numbers of another type.
  template <typename S>
  Pose<S> cast() const {
    return {R.template cast<S>(), p.template cast<S>()};
  }
};
/// A pose in doubles.
using Posed = Pose<double>;

/// A force f [N] and a moment m [N m] about a point that the name of the variable states.
template <typename T>
struct Wrench {
  Vector3<T> force = Vector3<T>::Zero();   ///< [N]
  Vector3<T> moment = Vector3<T>::Zero();  ///< [N m]

  /// Both about the same point, in the same axes.
  Wrench operator+(const Wrench& w) const { return {force + w.force, moment + w.moment}; }
  /// Both about the same point, in the same axes.
  Wrench operator-(const Wrench& w) const { return {force - w.force, moment - w.moment}; }
  Wrench operator-() const { return {-force, -moment}; }             ///< that of the reaction
  Wrench& operator+=(const Wrench& w) { return *this = *this + w; }  ///< about the same point
  Wrench& operator-=(const Wrench& w) { return *this = *this - w; }  ///< about the same point

  /// This wrench, which is about a point O, about a point P; p_PO leads from P to O [m].
  Wrench ShiftedBy(const Vector3<T>& p_PO) const { return {force, moment + p_PO.cross(force)}; }
  /// The same wrench in the axes of a frame whose orientation is R (columns: its axes here).
  Wrench In(const Matrix3<T>& R) const { return {R.transpose() * force, R.transpose() * moment}; }
  /// [f; m].
  Vector6<T> Stacked() const { return vmech::Stacked<T>(force, moment); }
};
/// A wrench in doubles.
using Wrenchd = Wrench<double>;

/// The matrix S(a) with S(a) b = a x b.
template <typename T>
Matrix3<T> CrossMatrix(const Vector3<T>& a) {
  Matrix3<T> S;
  S << T(0), -a.z(), a.y(), a.z(), T(0), -a.x(), -a.y(), a.x(), T(0);
  return S;
}

}  // namespace vmech
