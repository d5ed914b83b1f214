#pragma once

#include "vmech/base/pose.h"
#include "vmech/base/screw.h"

namespace vmech {

/// How far one orientation is from another, R_E = R_WH R_WG', as a vector in world axes that turns
/// G towards H.
enum class RotationError {
  kLogarithm,  ///< angle times axis: grows up to half a turn
  /// The skew part of R_E, sin(angle) times axis (paper eq. 3): shrinks again beyond a quarter turn
  /// and vanishes at half a turn, where it takes the opposite orientation for the right one.
  kPaper,
};

/// e1 [6; m, rad]: displacement and logarithm of the rotation that lead from G to H, world axes.
Vector6d HandError(const Posed& X_WG, const Posed& X_WH);
/// The same in registers.
Screw HandError(const Frame& X_WG, const Frame& X_WH) noexcept;
/// With the rotation as `kind` has it.
Screw HandError(RotationError kind, const Frame& X_WG, const Frame& X_WH) noexcept;

/// Its inverse: the pose to which `way` [dp; dr] leads from X, HandError(X, Displaced(X, way)) =
/// way for turns below half a turn.
Posed Displaced(const Posed& X, const Vector6d& way) noexcept;
/// The same in registers.
Frame Displaced(const Frame& X, const Screw& way) noexcept;

/// The rotation about r by |r| [rad].
Matrix3d RotationBy(const Vector3d& r) noexcept;

/// The error e(R_E) [rad].
Vector3d RotationErrorOf(RotationError kind, const Matrix3d& R_E);

/// A = de/deta at e = RotationErrorOf(kind, R_E), where eta turns G: R_WG becomes exp([eta]) R_WG,
/// R_E becomes R_E exp(-[eta]). A = -1 where e = 0. kLogarithm: A = -Jr(e)^-1, the inverse right
/// Jacobian of SO(3) [Sola, Deray & Atchuthan 2018, eq. 144].
Matrix3d RotationErrorJacobian(RotationError kind, const Matrix3d& R_E, const Vector3d& e);
/// The same for R_E = R_WH R_WG', which the logarithm does not need.
Matrix3d RotationErrorJacobian(RotationError kind, const Frame& X_WG, const Frame& X_WH,
                               const Vector3d& e) noexcept;

/// sum_i g_i d2e_i/deta2, symmetric.
Matrix3d RotationErrorCurvature(RotationError kind, const Matrix3d& R_E, const Vector3d& e,
                                const Vector3d& g);

}  // namespace vmech
