#include "vmech/mechanisms/exchange/mended_inertia.h"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>

#include "vmech/mechanisms/mass_properties.h"

namespace vmech {
namespace {

std::string Figures(const Matrix3d& I) {
  const Vector3d moments = PrincipalMoments(I);
  return fmt::format("[{:.6g}, {:.6g}, {:.6g}] kg m^2", moments[0], moments[1], moments[2]);
}

}  // namespace

Matrix3d NearestInertia(const Matrix3d& I_cm) {
  const Matrix3d S = 0.5 * I_cm.trace() * Matrix3d::Identity() - I_cm;
  const Eigen::SelfAdjointEigenSolver<Matrix3d> eigen(S);
  const Vector3d second_moments = eigen.eigenvalues().cwiseMax(0);
  const Matrix3d nearest =
      RotatedInertia(eigen.eigenvectors(), second_moments.asDiagonal());  // R S R'
  return nearest.trace() * Matrix3d::Identity() - nearest;
}

Mending MendInertia(MassProperties* properties) {
  Matrix3d& I = properties->I_Lcm;
  if (I == Matrix3d::Zero()) return {};
  if (properties->mass == 0) {
    const std::string before = Figures(I);
    I = Matrix3d::Zero();
    return {"no mass, but principal moments of inertia " + before, "they are dropped"};
  }
  const std::string defect = InertiaDefect(I, I.cwiseAbs().maxCoeff());
  if (defect.empty()) return {};
  I = NearestInertia(I);
  return {defect, "mended by the least change to " + Figures(I)};
}

}  // namespace vmech
