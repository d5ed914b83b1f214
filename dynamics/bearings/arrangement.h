#pragma once

#include <array>
#include <cmath>
#include <span>
#include <vector>

#include "vmech/base/pose.h"

namespace vmech {

/// Where the bearings of a joint sit: one, or two of which one is located axially and the other
/// floats.
struct Arrangement {
  std::vector<double> positions{0.0};  ///< along z from the joint's origin [m]; one or two
  int locating = 0;                    ///< index of the bearing that takes the axial force

  /// @throws std::invalid_argument naming the value and what is allowed.
  void Validate() const;
};

/// The force that a bearing transmits from the first link to the second, in the joint's axes [N].
struct BearingForce {
  Vector3d force = Vector3d::Zero();  ///< from the first link to the second

  double radial() const { return force.head<2>().norm(); }  ///< Fr [N]
  double axial() const { return std::abs(force.z()); }      ///< Fa [N]
};

/// The share of every bearing, and what no bearing of the arrangement can take.
struct ArrangementLoads {
  std::vector<std::vector<BearingForce>> forces;  ///< [bearing][pose]
  /// Moment across the axis about the only bearing [N m] per pose; zero with two bearings.
  std::vector<double> tilting_moment;
};

/// Equilibrium of the joint's wrench [f; m] with forces R_k at z_k:
///   sum R_k = f,   sum z_k e_z x R_k = m (x and y; z is the freedom of the joint).
/// With two bearings a and b: R_b.x = (m.y - z_a f.x) / (z_b - z_a),
/// R_b.y = (-m.x - z_a f.y) / (z_b - z_a), R_a = f - R_b; the locating bearing takes all of f.z.
/// The bearings are taken as pivots: they transmit no moment.
/// The shares of one wrench: R_a, and R_b where there is a second bearing; positions and locating
/// as in Arrangement. T: double or Taped.
template <typename T>
std::array<Vector3<T>, 2> SharesOf(const std::vector<T>& positions, int locating,
                                   const Wrench<T>& wrench);
/// The loads of each bearing at every pose, by SharesOf.
ArrangementLoads DistributeLoads(const Arrangement& arrangement, std::span<const Wrenchd> wrenches);

}  // namespace vmech
