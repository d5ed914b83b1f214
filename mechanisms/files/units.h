#pragma once

#include <array>

#include "vmech/mechanisms/expressions/quantity.h"
#include "vmech/mechanisms/expressions/unit.h"
#include "vmech/mechanisms/files/document.h"
#include "vmech/mechanisms/mechanism.h"

namespace vmech {

/// The units of a file: each figure is the size of one unit of the file in SI units and radians,
/// so that SI = figure * number. What a file does not state:
///   - length, angle, mass, time: m, rad, kg, s;
///   - inertia: mass * length^2, velocity: length / time, angular_velocity: angle / time;
///   - acceleration (gravity), density and everything that has a force in it stay SI (m/s^2,
///     kg/m^3, N, N m, N/m, N m/rad, N s/m, N m s/rad), whatever the length and the angle are,
///     unless stated by name.
struct Units {
  Unit length{1, {1}};                           ///< [m]
  Unit angle{1, {0, 0, 0, 1}};                   ///< [rad]
  Unit mass{1, {0, 1}};                          ///< [kg]
  Unit time{1, {0, 0, 1}};                       ///< [s]
  Unit velocity{1, {1, 0, -1}};                  ///< [m/s]
  Unit angular_velocity{1, {0, 0, -1, 1}};       ///< [rad/s]
  Unit acceleration{1, {1, 0, -2}};              ///< [m/s^2]
  Unit inertia{1, {2, 1}};                       ///< [kg m^2]
  Unit density{1, {-3, 1}};                      ///< [kg/m^3]
  Unit force{1, {1, 1, -2}};                     ///< [N]
  Unit torque{1, {2, 1, -2}};                    ///< [N m]
  Unit stiffness{1, {0, 1, -2}};                 ///< [N/m]
  Unit rotational_stiffness{1, {2, 1, -2, -1}};  ///< [N m/rad]
  Unit damping{1, {0, 1, -1}};                   ///< [N s/m]
  Unit rotational_damping{1, {2, 1, -1, -1}};    ///< [N m s/rad]

  /// What numbers without a unit count in.
  CountingUnits counting() const;
};

/// Reads a `units` block, as in {length: mm, angle: deg, torque: N mm}; an absent one is SI.
/// A unit is as in ParseUnit: "kg mm^2", "N m/deg".
Units ReadUnits(const Node& node);

/// The units of six numbers, along x, y, z and about x, y, z.
std::array<Unit, 6> SixUnits(const Unit& along, const Unit& about);

/// The length and the angle of the same block, with their symbols.
DisplayUnits DisplayUnitsOf(const Node& node, const Units& units);

}  // namespace vmech
