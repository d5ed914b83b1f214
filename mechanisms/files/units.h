#pragma once

#include <string_view>

#include "vmech/mechanisms/files/document.h"
#include "vmech/mechanisms/mechanism.h"

namespace vmech {

/// The units of a file: each figure is the size of one unit of the file in SI units and radians,
/// so that SI = figure * number. What a file does not state:
///   - length, angle, mass, time: m, rad, kg, s;
///   - inertia: mass * length^2, velocity: length / time, angular_velocity: angle / time;
///   - acceleration (gravity) and everything that has a force in it stay SI (m/s^2, N, N m, N/m,
///     N m/rad, N s/m, N m s/rad), whatever the length and the angle are, unless stated by name.
struct Units {
  double length = 1;                ///< [m]
  double angle = 1;                 ///< [rad]
  double mass = 1;                  ///< [kg]
  double time = 1;                  ///< [s]
  double velocity = 1;              ///< [m/s]
  double angular_velocity = 1;      ///< [rad/s]
  double acceleration = 1;          ///< [m/s^2]
  double inertia = 1;               ///< [kg m^2]
  double force = 1;                 ///< [N]
  double torque = 1;                ///< [N m]
  double stiffness = 1;             ///< [N/m]
  double rotational_stiffness = 1;  ///< [N m/rad]
  double damping = 1;               ///< [N s/m]
  double rotational_damping = 1;    ///< [N m s/rad]
};

/// Reads a `units` block, as in {length: mm, angle: deg, torque: N mm}; an absent one is SI.
/// A unit is a product of symbols with powers and at most one '/', as in "kg mm^2" or "N m/deg":
///   m km cm mm um in ft, rad mrad deg rev, kg g mg t lb, s ms min h, N kN mN lbf, rpm.
Units ReadUnits(const Node& node);

/// The length and the angle of the same block, with their symbols.
DisplayUnits DisplayUnitsOf(const Node& node, const Units& units);

}  // namespace vmech
