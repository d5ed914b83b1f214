#include "vmech/base/rotation_error.h"

#include <Eigen/Geometry>
#include <array>
#include <cmath>

#include "vmech/base/screw_algebra.h"

namespace vmech {
namespace {

Vector3d SkewPart(const Matrix3d& R) {
  return 0.5 * Vector3d(R(2, 1) - R(1, 2), R(0, 2) - R(2, 0), R(1, 0) - R(0, 1));
}

Matrix3d SymmetricPart(const Matrix3d& A) {
  return 0.5 * (A + A.transpose());
}

constexpr double kShortTurn = 1.0 / 16;  // sin^2 of half of 29 degrees

/// angle/sin(angle) of y = sin^2(angle/2) <= kShortTurn, to rounding:
///
///   1 + 2/3 y + 2/3 4/5 y^2 + 2/3 4/5 6/7 y^3 + ..
double AngleOverSine(double y) {
  constexpr auto c = [] {
    std::array<double, 13> terms{1};
    for (int n = 1; n < 13; ++n) terms[n] = terms[n - 1] * (2.0 * n) / (2 * n + 1);
    return terms;
  }();
  const double y2 = y * y, y4 = y2 * y2;
  const auto four = [&](int n) { return (c[n] + c[n + 1] * y) + (c[n + 2] + c[n + 3] * y) * y2; };
  return (four(0) + four(4) * y4) + (four(8) + c[12] * y4) * (y4 * y4);
}

Vector3d Logarithm(const Matrix3d& R) {
  const Vector3d skew = SkewPart(R);  // sin(angle) axis
  const double cosine = 0.5 * (R.trace() - 1), y = 0.5 * (1 - cosine);
  if (y <= kShortTurn) return AngleOverSine(y) * skew;
  if (cosine > 0) {
    const double sine = skew.norm();
    return std::atan2(sine, cosine) / sine * skew;
  }
  Eigen::Quaterniond turn(R);
  if (turn.w() < 0) turn.coeffs() = -turn.coeffs();
  const double sine = turn.vec().norm();  // of half the angle
  return 2 * std::atan2(sine, turn.w()) / sine * turn.vec();
}

/// Twice that of R_WH R_WG' = sum h g'.
Double4 TwiceSkewPart(const Frame& G, const Frame& H) {
  return Cross(G.x, H.x) + Cross(G.y, H.y) + Cross(G.z, H.z);
}

/// By a call of its own, which leaves the registers to the short ones.
[[gnu::noinline]] Double4 LongTurn(const Frame& G, const Frame& H) {
  return Double4Of(Logarithm(RotationOf(H) * RotationOf(G).transpose()));
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
  // [e]^2 = e e' - |e|^2
  const double e2 = e.squaredNorm(), k = CoefficientAt(e2).k, diagonal = 1 - k * e2;
  const Vector3d h = 0.5 * e, ke = k * e;
  Matrix3d J;
  J << diagonal + ke[0] * e[0], ke[0] * e[1] - h[2], ke[0] * e[2] + h[1],  //
      ke[1] * e[0] + h[2], diagonal + ke[1] * e[1], ke[1] * e[2] - h[0],   //
      ke[2] * e[0] - h[1], ke[2] * e[1] + h[0], diagonal + ke[2] * e[2];
  return J;
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

/// sin x/x and (1 - cos x)/x^2.
struct RodriguesCoefficients {
  double s, c;
};

RodriguesCoefficients RodriguesAt(double x2) {
  if (x2 < 0.01) {
    return {1 - x2 * (1.0 / 6 - x2 * (1.0 / 120 - x2 * (1.0 / 5040 - x2 * (1.0 / 362880)))),
            0.5 - x2 * (1.0 / 24 - x2 * (1.0 / 720 - x2 * (1.0 / 40320 - x2 * (1.0 / 3628800))))};
  }
  const double x = std::sqrt(x2), half = std::sin(x / 2);
  return {std::sin(x) / x, 2 * half * half / x2};
}

}  // namespace

Vector6d HandError(const Posed& X_WG, const Posed& X_WH) {
  return Vector6Of(HandError(FrameOf(X_WG), FrameOf(X_WH)));
}

Screw HandError(const Frame& G, const Frame& H) noexcept {
  // Trace and skew part of R_WH R_WG' = sum h g', which is not written down for a short turn.
  const Double4 traces = G.x * H.x + G.y * H.y + G.z * H.z;
  const double y = 0.25 * (3 - (traces[0] + traces[1] + traces[2]));
  if (y <= kShortTurn) {
    return {H.p - G.p, 0.5 * AngleOverSine(y) * TwiceSkewPart(G, H)};
  }
  return {H.p - G.p, LongTurn(G, H)};
}

Screw HandError(RotationError kind, const Frame& G, const Frame& H) noexcept {
  if (kind == RotationError::kLogarithm) return HandError(G, H);
  return {H.p - G.p, 0.5 * TwiceSkewPart(G, H)};
}

Posed Displaced(const Posed& X, const Vector6d& way) noexcept {
  return PoseOf(Displaced(FrameOf(X), ScrewOf(way)));
}

Frame Displaced(const Frame& X, const Screw& way) noexcept {
  const Double4& r = way.angular;
  const auto [s, c] = RodriguesAt(Dot(r, r));
  const auto turned = [&, s = s, c = c](const Double4& a) {
    const Double4 ra = Cross(r, a);
    return a + s * ra + c * Cross(r, ra);
  };
  return {turned(X.x), turned(X.y), turned(X.z), X.p + way.linear};
}

Matrix3d RotationBy(const Vector3d& r) noexcept {
  const Matrix3d S = CrossMatrix<double>(r);
  const auto [s, c] = RodriguesAt(r.squaredNorm());
  return Matrix3d::Identity() + s * S + c * S * S;
}

Vector3d RotationErrorOf(RotationError kind, const Matrix3d& R_E) {
  return kind == RotationError::kLogarithm ? Logarithm(R_E) : SkewPart(R_E);
}

Matrix3d RotationErrorJacobian(RotationError kind, const Matrix3d& R_E, const Vector3d& e) {
  if (kind == RotationError::kLogarithm) return -InverseRightJacobian(e);
  return 0.5 * (R_E.transpose() - R_E.trace() * Matrix3d::Identity());
}

Matrix3d RotationErrorJacobian(RotationError kind, const Frame& G, const Frame& H,
                               const Vector3d& e) noexcept {
  if (kind == RotationError::kLogarithm) return -InverseRightJacobian(e);
  return RotationErrorJacobian(kind, RotationOf(H) * RotationOf(G).transpose(), e);
}

Matrix3d RotationErrorCurvature(RotationError kind, const Matrix3d& R_E, const Vector3d& e,
                                const Vector3d& g) {
  if (kind == RotationError::kLogarithm) return LogarithmCurvature(e, g);
  // g'e'' = 1/2 tr([g]' R_E [u]^2), [u]^2 = u u' - |u|^2.
  const Matrix3d GR = CrossMatrix<double>(g).transpose() * R_E;
  return 0.5 * (SymmetricPart(GR) - GR.trace() * Matrix3d::Identity());
}

}  // namespace vmech
