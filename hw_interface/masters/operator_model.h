#pragma once

#include <functional>

#include "vmech/base/pose.h"

namespace vmech {

/// Where a simulated hand wants to be: the pose X_DT of its target and its twist V_DT = [v; w] at
/// To, axes of D.
struct HandTargetMotion {
  Posed X_DT;                        ///< target frame in the device's base
  Vector6d V_DT = Vector6d::Zero();  ///< [m/s, rad/s]
};
/// A target over time [s]. Called in the simulation's steps: it must not throw or allocate.
using HandMotion = std::function<HandTargetMotion(double time)>;

/// How firmly an operator holds the handle: mass that moves along, and a spring and a damper to the
/// target,
///
///   F_Ho = K (target - handle) + B (V_DT - V_DH),   K, B diagonal, rotations by their vector.
struct OperatorImpedance {
  double mass = 0;                    ///< that moves with the handle [kg], in [0, 5]
  double stiffness = 0, damping = 0;  ///< [N/m], [N s/m], >= 0
  double angular_stiffness = 0, angular_damping = 0;  ///< [N m/rad], [N m s/rad], >= 0
};

/// How firmly the simulated operator holds the handle.
enum class Grip { kAbsent, kLight, kRelaxed, kFirm };

/// `kRelaxed`: mass, damping and stiffness of an arm in a posture task, measured by van Beek et
/// al., Sci. Rep. 5:18004 (2015), figure 3 (one participant). `kLight` is a fourth of its stiffness
/// and half its mass, `kFirm` ten times its stiffness, both at the same damping ratio. The
/// rotational figures are those of a hand of 5 cm lever.
OperatorImpedance ImpedanceOf(Grip grip);

/// Force of the operator on the handle, about Ho, axes of D.
Wrenchd OperatorWrench(const OperatorImpedance& impedance, const HandTargetMotion& target,
                       const Posed& X_DH, const Vector6d& V_DH) noexcept;

/// Stays at a pose.
HandMotion HoldAt(const Posed& X_DT);
/// From one pose to another along a straight line and about one axis in `duration` [s], with least
/// jerk: s = 10 r^3 - 15 r^4 + 6 r^5 [Flash & Hogan 1985].
HandMotion ReachTo(const Posed& from, const Posed& to, double start, double duration);
/// Wanders about a pose: three sines of incommensurable frequencies up to 3 Hz per axis with phases
/// from `seed`, amplitudes in all `reach` [m] and `turn` [rad].
HandMotion Wander(const Posed& about, double reach, double turn, unsigned seed);

}  // namespace vmech
