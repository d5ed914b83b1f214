#pragma once

#include "vmech/mechanisms/cad/step/cad_assembly.h"
#include "vmech/mechanisms/mass_properties.h"

namespace vmech {

/// Volume and moments of solids in closed form, to be added and subtracted.
struct Moments {
  double volume = 0;
  Vector3d first = Vector3d::Zero();   ///< integral of r dV
  Matrix3d second = Matrix3d::Zero();  ///< integral of r r' dV

  Moments operator+(const Moments& m) const {
    return {volume + m.volume, first + m.first, second + m.second};
  }
  Moments operator-() const { return {-volume, -first, -second}; }
  Moments operator-(const Moments& m) const { return *this + -m; }
  Moments operator*(double s) const { return {s * volume, s * first, s * second}; }
};

/// Of a solid that is symmetric to the axes of X_WB: `spread` is the integral of (x^2, y^2, z^2) dV
/// about its centre, the origin of B.
inline Moments Placed(const Posed& X_WB, double volume, const Vector3d& spread) {
  const Matrix3d central = X_WB.R * spread.asDiagonal() * X_WB.R.transpose();
  return {volume, volume * X_WB.p, central + volume * X_WB.p * X_WB.p.transpose()};
}

inline Moments BoxMoments(const Vector3d& low, const Vector3d& high) {
  const Vector3d size = high - low;
  const double volume = size.prod();
  return Placed({Matrix3d::Identity(), 0.5 * (low + high)}, volume, volume / 12 * size.cwiseAbs2());
}

/// Around the axis from `foot` along the unit vector `z`.
inline Moments CylinderMoments(const Vector3d& foot, const Vector3d& z, double r, double h) {
  const double volume = M_PI * r * r * h;
  const Matrix3d along = z * z.transpose();
  const Vector3d center = foot + 0.5 * h * z;
  const Matrix3d central =
      volume * (r * r / 4 * (Matrix3d::Identity() - along) + h * h / 12 * along);
  return {volume, volume * center, central + volume * center * center.transpose()};
}

/// What a solid of revolution about z has, from the integrals of rho^2, rho^4, z rho^2, z^2 rho^2
/// dz.
inline Moments RevolvedMoments(double rho2, double rho4, double z_rho2, double z2_rho2) {
  const Vector3d second{M_PI / 4 * rho4, M_PI / 4 * rho4, M_PI * z2_rho2};
  return {M_PI * rho2, {0, 0, M_PI * z_rho2}, second.asDiagonal().toDenseMatrix()};
}

/// The moments in other axes: X_AB * moments in B.
inline Moments Moved(const Posed& X, const Moments& m) {
  const Vector3d first = X.R * m.first;
  return {m.volume, first + m.volume * X.p,
          X.R * m.second * X.R.transpose() + first * X.p.transpose() + X.p * first.transpose() +
              m.volume * X.p * X.p.transpose()};
}

/// Mass properties at a density [kg/m^3] of moments in millimetres.
inline MassProperties MassOf(const Moments& m, double density) {
  MassProperties result;
  result.mass = 1e-9 * density * m.volume;
  result.p_LoLcm = 1e-3 * m.first / m.volume;
  const Matrix3d second = 1e-15 * density * m.second;
  const Matrix3d about_origin = second.trace() * Matrix3d::Identity() - second;
  result.I_Lcm = InertiaAboutCenterOfGravity(about_origin, result.mass, result.p_LoLcm);
  return result;
}

}  // namespace vmech
