#pragma once

#include "vmech/mechanisms/pose.h"

namespace vmech {

/// The pose to which `way` [dp; dr] leads from X: HandError(X, Displaced(X, way)) = way.
inline Posed Displaced(const Posed& X, const Vector6d& way) noexcept {
  const Vector3d turn = way.tail<3>();
  const double angle = turn.norm();
  Posed moved{X.R, X.p + way.head<3>()};
  if (angle > 0) moved.R = Eigen::AngleAxisd(angle, turn / angle).toRotationMatrix() * X.R;
  return moved;
}

}  // namespace vmech
