#pragma once

#include <algorithm>
#include <limits>

namespace vmech {

/// The largest force and moment that something exerts, in any direction.
struct WrenchLimit {
  double force = std::numeric_limits<double>::infinity();   ///< largest force alone [N], > 0
  double moment = std::numeric_limits<double>::infinity();  ///< largest moment alone [N m], > 0
  /// Both draw on the same, as the motors of an arm: |f|/force + |m|/moment <= 1.
  bool together = false;

  /// The part of a force and a moment of these magnitudes that can be exerted; at most 1.
  double Share(double f, double m) const noexcept {
    const double by_force = f / force, by_moment = m / moment;
    const double asked = together ? by_force + by_moment : std::max(by_force, by_moment);
    return asked > 1 ? 1 / asked : 1;
  }
  /// The limit that is `factor` times as large.
  WrenchLimit Times(double factor) const noexcept {
    return {factor * force, factor * moment, together};
  }
};

}  // namespace vmech
