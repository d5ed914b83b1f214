#pragma once

#include "vmech/base/double4.h"
#include "vmech/base/pose.h"

namespace vmech {

// Poses, twists, wrenches and inertias as the kernels compute with them, world axes. T is the
// number of the computation: a double, or whatever takes several poses or a derivative along. In
// screws about a point of the world twists of a chain add up, and wrenches are handed on without
// being shifted; screw_algebra.h computes with them. Functions that return them by value are for
// the sources of the library alone: without AVX g++ puts such temporaries where they are not
// aligned.

/// The type of a vector of three numbers of type T; see Triple.
template <typename T>
struct TripleType {
  using type = Vector3<T>;  ///< of any other number
};
/// Three doubles are held in one register.
template <>
struct TripleType<double> {
  using type = Double4;  ///< its fourth number is zero
};
/// A vector in space: of doubles in one register, as a Double4 whose last number is zero.
template <typename T>
using Triple = typename TripleType<T>::type;

/// A frame B in the world: the columns of R_WB, and its origin Bo.
template <typename T>
struct FrameT {
  Vector3<T> x = Vector3<T>::UnitX(), y = Vector3<T>::UnitY(), z = Vector3<T>::UnitZ();  ///< axes
  Vector3<T> p = Vector3<T>::Zero();  ///< origin [m]
};
/// The same of doubles: each vector in one register, its fourth number zero.
template <>
struct FrameT<double> {
  Double4 x = {1, 0, 0, 0}, y = {0, 1, 0, 0}, z = {0, 0, 1, 0};  ///< axes
  Double4 p = {0, 0, 0, 0};                                      ///< origin [m]
};
/// A frame of doubles, in registers.
using Frame = FrameT<double>;

/// A twist: the velocity of what passes the reference point, and the angular velocity. Or a wrench:
/// the force, and its moment about the reference point. Or either about another point, if its
/// description says so.
template <typename T>
struct ScrewT {
  Vector3<T> linear = Vector3<T>::Zero();   ///< velocity or force
  Vector3<T> angular = Vector3<T>::Zero();  ///< angular velocity or moment
};
/// The same of doubles: each vector in one register.
template <>
struct ScrewT<double> {
  Double4 linear{};   ///< velocity or force
  Double4 angular{};  ///< angular velocity or moment
};
/// A screw of doubles, in registers.
using Screw = ScrewT<double>;

/// A frame in motion: its pose, and its twist about its own origin.
struct MovingFrame {
  Frame X;  ///< pose in the world
  Screw V;  ///< [v; w] of Bo and B [m/s, rad/s]
};

/// The inertia of a rigid body or of several as one, about the reference point.
template <typename T>
struct ScrewInertiaT {
  T mass = T(0);                           ///< [kg]
  Vector3<T> moment = Vector3<T>::Zero();  ///< mass times centre of gravity [kg m]
  /// Columns of the inertia [kg m^2]; x, y and z.
  Vector3<T> Ix = Vector3<T>::Zero(), Iy = Vector3<T>::Zero(), Iz = Vector3<T>::Zero();
};
/// The same of doubles: each row in one register.
template <>
struct ScrewInertiaT<double> {
  double mass = 0;           ///< [kg]
  Double4 moment{};          ///< mass times centre of gravity [kg m]
  Double4 Ix{}, Iy{}, Iz{};  ///< [kg m^2]
};
/// An inertia of doubles, in registers.
using ScrewInertia = ScrewInertiaT<double>;

}  // namespace vmech
