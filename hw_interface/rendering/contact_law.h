#pragma once

#include "vmech/base/pose.h"

namespace vmech {

/// What the constraint answers to a violation e1 by the hand.
enum class ContactKind {
  kLinear,        ///< w_c = K e1 (paper eq. 11)
  kViscoelastic,  ///< w_c = K e1 + B e1'
  kHuntCrossley,  ///< w_c = K e1 (1 + a d'), d = |e1| [Hunt & Crossley 1975], pull only
};

/// How the constraint pulls at the hand that leaves the mechanism: w_c as a function of e1 = [p; r]
/// from the mechanism to the hand and its rate. Hunt and Crossley's law, with exponent 1, loses
/// energy without the jump at e1 = 0 that a damper makes; for positions and rotations apart.
struct ContactLaw {
  ContactKind kind = ContactKind::kLinear;  ///< linear, viscoelastic or Hunt and Crossley's
  Vector6d stiffness = Vector6d::Zero();    ///< K, diagonal [N/m], [N m/rad], >= 0
  Vector6d damping = Vector6d::Zero();      ///< B of kViscoelastic, diagonal [N s/m], [N m s/rad]
  /// a of kHuntCrossley for positions [s/m] and for rotations [s/rad], >= 0. What strikes at a
  /// speed v bounces off at about (1 - a v / 1.5) v, as long as a v is small.
  double loss = 1, angular_loss = 0.1;  ///< `angular_loss` is that for rotations

  /// w_c [N, N m] at a violation e1 [m, rad] that changes at `rate` [m/s, rad/s]: what the hand
  /// exerts on the mechanism through the constraint, along e1. The hand feels -w_c.
  Vector6d Wrench(const Vector6d& e1, const Vector6d& rate) const noexcept;
  /// 1/2 e1' K e1 [J].
  double StoredEnergy(const Vector6d& e1) const noexcept {
    return 0.5 * e1.dot(stiffness.cwiseProduct(e1));
  }
};

}  // namespace vmech
