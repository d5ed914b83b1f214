#pragma once

#include <string>

#include "vmech/hw_interface/masters/device_info.h"

namespace vmech {

/// What a master can render without making energy, from its own physics: period T, delay t_d,
/// damping b, dry friction f_c, resolution D, mass m.
struct RenderingBounds {
  /// Passive with any hand: K (T/2 + t_d) + |B| <= b [Colgate & Schenkel 1994, with delay].
  double passive_stiffness = 0;
  /// Stable when nobody holds it: K (T/2 + t_d) <= b + B, for light damping [Gil et al. 2004;
  /// Hulin et al. 2013].
  double stable_stiffness = 0;
  /// No limit cycle of one encoder step: K <= min(2 b/T, 2 f_c/D) [Abbott & Okamura 2005]. Infinite
  /// where the device states no resolution.
  double quiet_stiffness = 0;
  /// Rendered damping alone: B <= b, for any hand.
  double passive_damping = 0;
  /// Inertia rendered from the measured acceleration: v'_k = -(m_v/m) v'_k-1 dies out while m_v <
  /// m.
  double stable_inertia = 0;
};

/// With `damping` B rendered beside the spring. Stiffness is never below zero.
RenderingBounds BoundsOf(const HandlePhysics& handle, double period, double delay,
                         double damping = 0);

/// Spring and damper of the rendered constraint, diagonal: x, y, z, then rotations about them.
struct RenderingGains {
  Vector6d stiffness = Vector6d::Zero();  ///< [N/m], [N m/rad]
  Vector6d damping = Vector6d::Zero();    ///< [N s/m], [N m s/rad]
};

/// The wanted gains, at most at the bounds of passivity: damping first, the spring with what is
/// left of b. Not-a-number and negative gains become zero.
RenderingGains LimitedGains(const DeviceInfo& info, const RenderingGains& wanted);

/// The bounds in words, one line per kind of motion.
std::string BoundsReport(const DeviceInfo& info);

}  // namespace vmech
