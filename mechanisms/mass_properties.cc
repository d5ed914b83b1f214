#include "vmech/mechanisms/mass_properties.h"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>

#include "vmech/base/dual.h"

namespace vmech {
namespace {

constexpr double kNegativeTolerance = 1e-6;  // of the scale: a moment that ought to be zero
constexpr double kTriangleTolerance = 5e-3;  // of the scale: half a unit in the third digit

/// m (p.p 1 - p p'), the inertia of a point mass.
template <typename T>
Matrix3<T> PointInertia(const T& mass, const Vector3<T>& p) {
  return mass * (p.squaredNorm() * Matrix3<T>::Identity() - p * p.transpose());
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
  return I_cm + PointInertia<double>(mass, p_PBcm);
}

Matrix3d InertiaAboutCenterOfGravity(const Matrix3d& I_P, double mass, const Vector3d& p_PBcm) {
  return I_P - PointInertia<double>(mass, p_PBcm);
}

template <typename T>
BodyNumbers<T> InFrame(const Pose<T>& X_AB, const BodyNumbers<T>& body_B) {
  return {body_B.mass, X_AB * body_B.p_cm, X_AB.R * body_B.I_cm * X_AB.R.transpose()};
}

template <typename T>
BodyNumbers<T> Composed(const std::vector<BodyNumbers<T>>& bodies) {
  BodyNumbers<T> whole;
  for (const BodyNumbers<T>& body : bodies) {
    whole.mass += body.mass;
    whole.p_cm += body.mass * body.p_cm;
  }
  if (whole.mass > T(0)) whole.p_cm /= whole.mass;
  for (const BodyNumbers<T>& body : bodies) {
    const Vector3<T> p = body.p_cm - whole.p_cm;
    whole.I_cm += body.I_cm + PointInertia<T>(body.mass, p);
  }
  const Matrix3<T> transposed = whole.I_cm.transpose();
  whole.I_cm = T(0.5) * (whole.I_cm + transposed);
  return whole;
}

template BodyNumbers<double> InFrame(const Posed&, const BodyNumbers<double>&);
template BodyNumbers<Dual> InFrame(const Pose<Dual>&, const BodyNumbers<Dual>&);
template BodyNumbers<double> Composed(const std::vector<BodyNumbers<double>>&);
template BodyNumbers<Dual> Composed(const std::vector<BodyNumbers<Dual>>&);

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
