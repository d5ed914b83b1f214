#pragma once

#include <string>
#include <vector>

#include "vmech/base/pose.h"
#include "vmech/mechanisms/mechanism.h"

namespace vmech {

// Inertia matrices are symmetric, [kg m^2]. I_P is about a point P; its axes are those of the frame
// that the function speaks of.

/// The inertia matrix with these elements [kg m^2]. The elements off the diagonal are minus the
/// products of inertia: I_xy = -integral of x y dm.
Matrix3d InertiaFromElements(double xx, double yy, double zz, double xy, double xz, double yz);

/// The inertia in axes A of a body whose inertia in axes B is given: R_AB I R_AB'.
Matrix3d RotatedInertia(const Matrix3d& R_AB, const Matrix3d& I_B);

/// Parallel axes (Huygens and Steiner): I_P = I_cm + m (p.p 1 - p p'), p from P to the centre of
/// gravity.
Matrix3d InertiaAboutPoint(const Matrix3d& I_cm, double mass, const Vector3d& p_PBcm);
/// The inverse of InertiaAboutPoint: I_cm from I_P.
Matrix3d InertiaAboutCenterOfGravity(const Matrix3d& I_P, double mass, const Vector3d& p_PBcm);

/// A rigid body as numbers, T double or Dual: mass [kg], centre of gravity [m] and inertia about
/// it [kg m^2] in some frame.
template <typename T>
struct BodyNumbers {
  T mass = T(0);                         ///< [kg]
  Vector3<T> p_cm = Vector3<T>::Zero();  ///< centre of gravity [m]
  Matrix3<T> I_cm = Matrix3<T>::Zero();  ///< about it [kg m^2]
};
/// The numbers in frame A of a body whose numbers in frame B are given.
template <typename T>
BodyNumbers<T> InFrame(const Pose<T>& X_AB, const BodyNumbers<T>& body_B);
/// Several bodies in one frame as one, by the parallel axis theorem.
template <typename T>
BodyNumbers<T> Composed(const std::vector<BodyNumbers<T>>& bodies);

/// The principal moments [kg m^2], ascending.
Vector3d PrincipalMoments(const Matrix3d& I);

/// Why no real body has this inertia, in words; empty if some distribution of mass has it: no
/// principal moment is below zero and none above the sum of the two others. A moment of zero (a
/// point, a thin rod) is accepted. `scale` [kg m^2] is the size of the figures from which the
/// matrix was computed; they are taken to be rounded to three digits at worst, as CAD systems print
/// them.
std::string InertiaDefect(const Matrix3d& I_cm, double scale);

}  // namespace vmech
