#pragma once

#include <algorithm>
#include <cmath>

namespace vmech {

/// Implicit steps only lose energy; what centrifugal forces, taken at the start of a step, add
/// beyond what was lost before is taken out of the velocities.
class EnergyLimit {
 public:
  /// After a step that has gained `gained` [J] beyond the work that was done on it, with `kinetic`
  /// energy [J] at its end: the factor on its velocities.
  double FactorOfVelocities(double gained, double kinetic) noexcept {
    constexpr double kMemory = 0.05;  // of the kinetic energy that losses are remembered for
    lost_ = std::min(lost_ - gained, kMemory * kinetic);
    if (lost_ >= 0 || kinetic == 0) return 1;
    const double factor = std::sqrt(std::max(0.0, 1 + lost_ / kinetic));
    lost_ = 0;
    return factor;
  }
  /// The next step has to make up for this much too [J].
  void Owe(double energy) noexcept { lost_ -= energy; }
  void Forget() noexcept { lost_ = 0; }  ///< what was lost or owed before does not count
  double remembered() const noexcept { return std::max(0.0, lost_); }  ///< losses [J]

 private:
  double lost_ = 0;  // energy that steps may give back [J]
};

}  // namespace vmech
