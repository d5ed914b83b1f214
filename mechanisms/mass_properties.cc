#include "vmech/mechanisms/mass_properties.h"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>

namespace vmech {
namespace {

constexpr double kNegativeTolerance = 1e-6;  // of the scale: a moment that ought to be zero
constexpr double kTriangleTolerance = 5e-3;  // of the scale: half a unit in the third digit

/// m (p.p 1 - p p'), the inertia of a point mass.
Matrix3d PointInertia(double mass, const Vector3d& p) {
  return mass * (p.squaredNorm() * Matrix3d::Identity() - p * p.transpose());
}

}  // namespace

Matrix3d InertiaFromElements(double xx, double yy, double zz, double xy, double xz, double yz) {
  Matrix3d I;
  I << xx, xy, xz, xy, yy, yz, xz, yz, zz;
  return I;
}

Matrix3d RotatedInertia(const Matrix3d& R_AB, const Matrix3d& I_B) {
  const Matrix3d I_A = R_AB * I_B * R_AB.transpose();
  return 0.5 * (I_A + I_A.transpose());
}

Matrix3d InertiaAboutPoint(const Matrix3d& I_cm, double mass, const Vector3d& p_PBcm) {
  return I_cm + PointInertia(mass, p_PBcm);
}

Matrix3d InertiaAboutCenterOfGravity(const Matrix3d& I_P, double mass, const Vector3d& p_PBcm) {
  return I_P - PointInertia(mass, p_PBcm);
}

Vector3d PrincipalMoments(const Matrix3d& I) {
  return Eigen::SelfAdjointEigenSolver<Matrix3d>(I, Eigen::EigenvaluesOnly).eigenvalues();
}

std::string InertiaDefect(const Matrix3d& I_cm, double scale) {
  const Vector3d moments = PrincipalMoments(I_cm);
  const std::string figures =
      fmt::format("principal moments {:.6g}, {:.6g}, {:.6g} kg m^2 about the centre of gravity",
                  moments[0], moments[1], moments[2]);
  if (!(moments[0] >= -kNegativeTolerance * scale)) {
    return "the inertia is not positive definite: " + figures;
  }
  if (!(moments[2] <= moments[0] + moments[1] + kTriangleTolerance * scale)) {
    return "the largest moment of inertia exceeds the sum of the two others: " + figures;
  }
  return {};
}

}  // namespace vmech
