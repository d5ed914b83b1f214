#pragma once

#include <string>

#include "vmech/mechanisms/mechanism.h"

namespace vmech {

/// Inertia matrices: symmetric, [kg m^2]. I_P is about a point P, in the axes at hand.
/// The elements off the diagonal are minus the products of inertia: I_xy = -integral of x y dm.

Matrix3d InertiaFromElements(double xx, double yy, double zz, double xy, double xz, double yz);

/// The inertia in axes A of a body whose inertia in axes B is given: R_AB I R_AB'.
Matrix3d RotatedInertia(const Matrix3d& R_AB, const Matrix3d& I_B);

/// Parallel axes (Huygens and Steiner): I_P = I_cm + m (p.p 1 - p p'), p from P to the centre of
/// gravity.
Matrix3d InertiaAboutPoint(const Matrix3d& I_cm, double mass, const Vector3d& p_PBcm);
/// The inverse: I_cm from I_P.
Matrix3d InertiaAboutCenterOfGravity(const Matrix3d& I_P, double mass, const Vector3d& p_PBcm);

/// The principal moments [kg m^2], ascending.
Vector3d PrincipalMoments(const Matrix3d& I);

/// What no real body has, in words; empty if the inertia is that of some distribution of mass:
/// no principal moment below zero and none above the sum of the two others. A moment of zero
/// (a point, a thin rod) is accepted. `scale` [kg m^2] is the size of the figures from which the
/// matrix was computed; they are taken to be rounded to three digits at worst, as CAD systems
/// print them.
std::string InertiaDefect(const Matrix3d& I_cm, double scale);

}  // namespace vmech
