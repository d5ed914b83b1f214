#include "vmech/kinematics/loops/loop_derivatives.h"

#include <Eigen/Geometry>
#include <cmath>

namespace vmech {
namespace {

Matrix3d SymmetricPart(const Matrix3d& A) {
  return 0.5 * (A + A.transpose());
}

/// d2(a . y)/deta2 of a vector y that turns with eta: u -> a . (u x (u x y)).
Matrix3d TurningCurvature(const Vector3d& a, const Vector3d& y) {
  return SymmetricPart(a * y.transpose()) - a.dot(y) * Matrix3d::Identity();
}

/// Joints that turn about z forbid rho = s(m_z) (-m_y, m_x), m = z_M in F, s^2 = 2/(1 + m_z).
struct AxisTilt {
  explicit AxisTilt(const Matrix3d& R_FM)
      : m(R_FM.col(2)), s(std::sqrt(2 / (1 + m.z() + 1e-300))), ds(-s * s * s / 4) {}

  // [dm = eta x m;  ds/dm_z = -s^3/4]
  Matrix3d Jacobian() const {
    Matrix3d D;
    D << s * m.z() - ds * m.y() * m.y(), ds * m.x() * m.y(), -s * m.x(),  //
        ds * m.x() * m.y(), s * m.z() - ds * m.x() * m.x(), -s * m.y(),   //
        0, 0, 1;
    return D;
  }

  /// Of g_x rho_x + g_y rho_y = s(m_z) (h . m), h = (g_y, -g_x, 0).
  Matrix3d Curvature(const Vector3d& g) const {
    const Vector3d h(g.y(), -g.x(), 0), z = Vector3d::UnitZ();
    const double dds = 3.0 / 16 * std::pow(s, 5);
    const Matrix3d M = CrossMatrix<double>(m);
    const Matrix3d H =
        dds * h.dot(m) * z * z.transpose() + ds * (z * h.transpose() + h * z.transpose());
    return M.transpose() * H * M + TurningCurvature(ds * h.dot(m) * z + s * h, m);
  }

  Vector3d m;
  double s, ds;
};

/// The turn 2 atan2(z, w) of a rotation with quaternion (w, x, y, z) about z.
struct TurnAboutZ {
  explicit TurnAboutZ(const Matrix3d& R_FM) {
    const Eigen::Quaterniond q(R_FM);
    const double w = q.w(), x = q.x(), y = q.y(), z = q.z();
    norm2 = w * w + z * z;
    // From q' = 1/2 (0, eta) q: w z' - z w' = alpha . eta / 2,  w w' + z z' = beta . eta / 2.
    alpha = Vector3d(w * y + z * x, z * y - w * x, norm2);
    beta = Vector3d(z * y - w * x, -w * y - z * x, 0);
  }
  Vector3d Gradient() const { return alpha / norm2; }
  Matrix3d Curvature() const { return -SymmetricPart(alpha * beta.transpose()) / (norm2 * norm2); }

  double norm2;
  Vector3d alpha, beta;
};

/// rho = 2 sin(angle/2) axis = twice the vector of the quaternion (w, rho/2), w >= 0.
double HalfAngleCosine(const Matrix3d& R_FM) {
  return 0.5 * std::sqrt(std::max(0.0, 1 + R_FM.trace()));
}

Vector3d Chord(const LoopState<double>& state, JointType type) {
  return type == JointType::kPrismatic ? Vector3d(-state.e2.segment<3>(2))
                                       : Vector3d(-state.e2.segment<3>(3));
}

}  // namespace

Matrix3d LoopRotationJacobian(const Loop& loop, const LoopState<double>& state) {
  switch (loop.type) {
    case JointType::kSpherical:
    case JointType::kUniversal:
      return Matrix3d::Identity();
    case JointType::kPrismatic:
    case JointType::kWeld:
      return HalfAngleCosine(state.R_FM) * Matrix3d::Identity() -
             0.5 * CrossMatrix<double>(Chord(state, loop.type));
    case JointType::kScrew: {
      Matrix3d D = AxisTilt(state.R_FM).Jacobian();
      D.row(2) = TurnAboutZ(state.R_FM).Gradient();
      return D;
    }
    default:
      return AxisTilt(state.R_FM).Jacobian();
  }
}

Matrix3d LoopRotationCurvature(const Loop& loop, const LoopState<double>& state, const double* mu) {
  const Vector3d g = WrenchOfMultipliers(loop, state, mu).moment;
  switch (loop.type) {
    case JointType::kSpherical:
      return Matrix3d::Zero();
    case JointType::kUniversal:
      return mu[3] * TurningCurvature(Vector3d::UnitX(), state.R_FM.col(1));
    case JointType::kPrismatic:
    case JointType::kWeld:
      // q'' = -1/4 |u|^2 q along exp(t u)
      return -0.25 * g.dot(Chord(state, loop.type)) * Matrix3d::Identity();
    case JointType::kScrew:
      return AxisTilt(state.R_FM).Curvature(g) + g.z() * TurnAboutZ(state.R_FM).Curvature();
    default:
      return AxisTilt(state.R_FM).Curvature(g);
  }
}

}  // namespace vmech
