#include "vmech/kinematics/rotation_error.h"

#include <Eigen/Geometry>
#include <cmath>

namespace vmech {
namespace {

Vector3d SkewPart(const Matrix3d& R) {
  return 0.5 * Vector3d(R(2, 1) - R(1, 2), R(0, 2) - R(2, 0), R(1, 0) - R(0, 1));
}

Matrix3d SymmetricPart(const Matrix3d& A) {
  return 0.5 * (A + A.transpose());
}

/// asin(x)/x of x^2 <= 0.01, to rounding.
double ArcsineRatio(double x2) {
  double sum = 143.0 / 10240;
  for (double c : {231.0 / 13312, 63.0 / 2816, 35.0 / 1152, 5.0 / 112, 3.0 / 40, 1.0 / 6, 1.0}) {
    sum = c + x2 * sum;
  }
  return sum;
}

Vector3d Logarithm(const Matrix3d& R) {
  const Vector3d skew = SkewPart(R);  // sin(angle) axis
  const double sine2 = skew.squaredNorm(), cosine = 0.5 * (R.trace() - 1);
  if (cosine > 0) {
    if (sine2 < 0.01) return ArcsineRatio(sine2) * skew;
    const double sine = std::sqrt(sine2);
    return std::atan2(sine, cosine) / sine * skew;
  }
  Eigen::Quaterniond turn(R);
  if (turn.w() < 0) turn.coeffs() = -turn.coeffs();
  const double sine = turn.vec().norm();  // of half the angle
  return 2 * std::atan2(sine, turn.w()) / sine * turn.vec();
}

/// k(theta) = 1/theta^2 - cot(theta/2)/(2 theta) of Jr^-1 = 1 + [e]/2 + k [e]^2, and its slope
/// k'(theta)/theta.
struct JacobianCoefficient {
  double k, slope;
};

JacobianCoefficient CoefficientAt(double theta2) {
  constexpr double kSeries = 0.06;  // below, the closed forms lose more digits than the series
  if (theta2 < kSeries) {
    return {1.0 / 12 + theta2 * (1.0 / 720 + theta2 * (1.0 / 30240 + theta2 / 1209600)),
            1.0 / 360 + theta2 * (1.0 / 7560 + theta2 * (1.0 / 201600 + theta2 / 5987520))};
  }
  const double theta = std::sqrt(theta2);
  const double sine = std::sin(theta / 2), cot = std::cos(theta / 2) / sine;
  return {1 / theta2 - cot / (2 * theta),
          (-2 / theta2 + 1 / (4 * sine * sine) + cot / (2 * theta)) / theta2};
}

Matrix3d InverseRightJacobian(const Vector3d& e) {
  const Matrix3d S = CrossMatrix<double>(e);
  return Matrix3d::Identity() + 0.5 * S + CoefficientAt(e.squaredNorm()).k * (S * S);
}

// With a = Jr^-1 u, along eta = t u: e' = -a and g'e'' = g' (dJr^-1/de . a) u =: a'B u.
Matrix3d LogarithmCurvature(const Vector3d& e, const Vector3d& g) {
  const JacobianCoefficient c = CoefficientAt(e.squaredNorm());
  const Matrix3d G = CrossMatrix<double>(g), E = CrossMatrix<double>(e);
  const Matrix3d GxE = CrossMatrix<double>(g.cross(e));
  const Vector3d EEg = e.cross(e.cross(g));
  const Matrix3d B = -0.5 * G - c.k * (G * E + GxE) + c.slope * e * EEg.transpose();
  return SymmetricPart(InverseRightJacobian(e).transpose() * B);
}

}  // namespace

Vector6d HandError(const Posed& X_WG, const Posed& X_WH) {
  return Stacked<double>(X_WH.p - X_WG.p, Logarithm(X_WH.R * X_WG.R.transpose()));
}

Posed Displaced(const Posed& X, const Vector6d& way) noexcept {
  return {RotationBy(way.tail<3>()) * X.R, X.p + way.head<3>()};
}

Matrix3d RotationBy(const Vector3d& r) noexcept {
  const double x2 = r.squaredNorm();
  double s = 0, c = 0;  // sin x/x and (1 - cos x)/x^2
  if (x2 < 0.01) {
    s = 1 - x2 * (1.0 / 6 - x2 * (1.0 / 120 - x2 * (1.0 / 5040 - x2 * (1.0 / 362880))));
    c = 0.5 - x2 * (1.0 / 24 - x2 * (1.0 / 720 - x2 * (1.0 / 40320 - x2 * (1.0 / 3628800))));
  } else {
    const double x = std::sqrt(x2), half = std::sin(x / 2);
    s = std::sin(x) / x;
    c = 2 * half * half / x2;
  }
  Matrix3d R = c * r * r.transpose() + CrossMatrix<double>(s * r);
  R.diagonal().array() += 1 - c * x2;
  return R;
}

Vector3d RotationErrorOf(RotationError kind, const Matrix3d& R_E) {
  return kind == RotationError::kLogarithm ? Logarithm(R_E) : SkewPart(R_E);
}

Matrix3d RotationErrorJacobian(RotationError kind, const Matrix3d& R_E, const Vector3d& e) {
  if (kind == RotationError::kLogarithm) return -InverseRightJacobian(e);
  return 0.5 * (R_E.transpose() - R_E.trace() * Matrix3d::Identity());
}

Matrix3d RotationErrorCurvature(RotationError kind, const Matrix3d& R_E, const Vector3d& e,
                                const Vector3d& g) {
  if (kind == RotationError::kLogarithm) return LogarithmCurvature(e, g);
  // g'e'' = 1/2 tr([g]' R_E [u]^2), [u]^2 = u u' - |u|^2.
  const Matrix3d GR = CrossMatrix<double>(g).transpose() * R_E;
  return 0.5 * (SymmetricPart(GR) - GR.trace() * Matrix3d::Identity());
}

}  // namespace vmech
