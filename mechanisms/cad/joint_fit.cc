#include "vmech/mechanisms/cad/joint_fit.h"

#include <cmath>

namespace vmech {
namespace {

double AngleOf(const Matrix3d& R) {
  return Eigen::AngleAxisd(R).angle();
}

/// The turn about z that comes nearest to R.
double TurnAboutZ(const Matrix3d& R) {
  return std::atan2(R(1, 0) - R(0, 1), R(0, 0) + R(1, 1));
}

Matrix3d AboutZ(double angle) {
  return Eigen::AngleAxisd(angle, Vector3d::UnitZ()).toRotationMatrix();
}

/// R = Rx(a) Ry(b), as near as it gets.
std::vector<double> UniversalAngles(const Matrix3d& R) {
  return {std::atan2(R(2, 1), R(1, 1)), std::atan2(R(0, 2), R(0, 0))};
}

Matrix3d UniversalRotation(const std::vector<double>& angles) {
  return (Eigen::AngleAxisd(angles[0], Vector3d::UnitX()) *
          Eigen::AngleAxisd(angles[1], Vector3d::UnitY()))
      .toRotationMatrix();
}

}  // namespace

JointFit FitJoint(JointType type, const Posed& X_FM) {
  const Matrix3d& R = X_FM.R;
  const Vector3d& p = X_FM.p;
  JointFit fit;
  fit.distance = p.norm();
  const Vector3d z = R.col(2);
  fit.angle = std::atan2(std::hypot(z.x(), z.y()), z.z());
  const double turn = TurnAboutZ(R);
  const double tilt = AngleOf(R * AboutZ(turn).transpose());
  const double aside = std::hypot(p.x(), p.y());
  switch (type) {
    case JointType::kRevolute:
    case JointType::kScrew:
      fit.start = {turn};
      fit.gap = p.norm();
      fit.skew = tilt;
      break;
    case JointType::kPrismatic:
      fit.start = {p.z()};
      fit.gap = aside;
      fit.skew = AngleOf(R);
      break;
    case JointType::kCylindrical:
      fit.start = {p.z(), turn};
      fit.gap = aside;
      fit.skew = tilt;
      break;
    case JointType::kUniversal:
      fit.start = UniversalAngles(R);
      fit.gap = p.norm();
      fit.skew = AngleOf(R * UniversalRotation(fit.start).transpose());
      break;
    case JointType::kSpherical: {
      const Eigen::Quaterniond q(R);
      fit.start = {q.w(), q.x(), q.y(), q.z()};
      fit.gap = p.norm();
      break;
    }
    case JointType::kPlanar:
      fit.start = {p.x(), p.y(), turn};
      fit.gap = std::abs(p.z());
      fit.skew = tilt;
      break;
    case JointType::kWeld:
      fit.gap = p.norm();
      fit.skew = AngleOf(R);
      break;
  }
  return fit;
}

}  // namespace vmech
