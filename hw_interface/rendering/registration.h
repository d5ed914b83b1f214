#pragma once

#include "vmech/base/screw.h"

namespace vmech {

/// How the master's handle is laid over the mechanism's world W: D is placed by X_WD, and the
/// hand's frame is the handle turned by R_HK, so that it can coincide with a grasp frame of any
/// orientation.
///
///   X_WK = X_WD X_DH R_HK,   F_Ho_D = R_WD' F_Ko_W   (Ko = Ho)
struct Registration {
  Posed X_WD;                            ///< the device's base in the mechanism's world
  Matrix3d R_HK = Matrix3d::Identity();  ///< the hand's axes in the handle's

  Posed HandInWorld(const Posed& X_DH) const noexcept;  ///< X_WK of a sample
  /// The hand, of a handle that moves in D.
  void TakeHandInWorld(const MovingFrame& handle, MovingFrame* hand) const noexcept;
};

/// The registration that puts the hand where the grasp frame is, with the device's axes along R_WD:
/// a grasp without a jump.
Registration GraspedAt(const Matrix3d& R_WD, const Posed& X_DH, const Posed& X_WG) noexcept;

}  // namespace vmech
