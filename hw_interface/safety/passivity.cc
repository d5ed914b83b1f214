#include "vmech/hw_interface/safety/passivity.h"

#include <algorithm>

#include "vmech/base/check_range.h"
#include "vmech/base/screw_algebra.h"

namespace vmech {
namespace {

/// Over less than this the steps of encoders are taken for speed [s].
constexpr double kShortest = 1e-3;

/// The speed, squared, at which a force gives the power that is forgiven [W]. Slower, it gives the
/// hand nothing that counts, and where a hand turns round, its direction swings.
double SlowSpeed2(const Screw& F, const PassivityOptions& options) {
  constexpr double kLeast = 1e-6;  // [N^2]
  const double moment2 = Dot(F.angular, F.angular) / (options.lever * options.lever);
  const double force2 = Dot(F.linear, F.linear) + moment2;
  return options.forgiven * options.forgiven / std::max(force2, kLeast);
}

}  // namespace

void PassivityOptions::Validate() const {
  CheckRange("PassivityOptions", "credit", credit, 0, 10);
  CheckRange("PassivityOptions", "lever", lever, 1e-3, 10);
  CheckRange("PassivityOptions", "grace", grace, 0, 1);
  CheckRange("PassivityOptions", "forgiven", forgiven, 0, 10);
  CheckRange("PassivityOptions", "largest_debt", largest_debt, 1e-4, 100);
}

double MostDamping(double mass, const DeviceInfo& info) noexcept {
  return mass / (2 * std::max(info.period, kShortest) + 4 * info.delay);
}

PassivityController::PassivityController(const PassivityOptions& options, const DeviceInfo& info)
    : options_(options), period_(info.period) {
  options.Validate();
  const double lever2 = options.lever * options.lever;
  const auto isotropic = [](double linear, double angular) {
    return Screw{Double4Of(Vector3d::Constant(linear)), Double4Of(Vector3d::Constant(angular))};
  };
  own_damping_ = isotropic(info.linear.damping, info.angular.damping);
  weight_ = isotropic(1, lever2);
  // The lighter of the two, as a mass: the angular one turns at the lever.
  double mass = info.linear.mass;
  if (info.angular.mass > 0) mass = std::min(mass, info.angular.mass / lever2);
  max_damping_ = MostDamping(mass, info);
}

void PassivityController::Reset() noexcept {
  energy_ = 0;
  V_ = mean_V_ = {};
  knows_stored_ = false;
}

void PassivityController::Observe(const Screw& F_Ho_D, const Screw& dX, double elapsed,
                                  double stored_energy) noexcept {
  if (!knows_stored_) stored_ = stored_energy;
  knows_stored_ = true;
  const Screw V = (1 / elapsed) * dX;
  V_ += std::min(1.0, elapsed / kShortest) * (V - V_);
  energy_ += Power(Scaled(own_damping_, V) - F_Ho_D, dX) - (stored_energy - stored_);
  if (energy_ < 0) energy_ = std::min(0.0, energy_ + options_.forgiven * elapsed);
  energy_ = std::min(energy_, options_.credit);
  stored_ = stored_energy;
  constexpr double kMean = 5e-3;  // [s]
  mean_V_ += std::min(1.0, elapsed / kMean) * (V - mean_V_);
}

bool PassivityController::Control(Screw* F_Ho_D) const noexcept {
  constexpr double kAtRest = 1e-12;    // [m^2/s^2]: no motion that could dissipate
  constexpr double kRounding = 1e-12;  // [J]: of stored energies, at rest
  if (!options_.enabled || energy_ >= -kRounding) return false;
  const Screw wanted = *F_Ho_D;
  const double debt = -energy_;
  const double beyond = std::max(0.0, debt - options_.grace);
  Screw& F = *F_Ho_D;
  F = std::max(0.0, 1 - beyond / options_.largest_debt) * wanted;
  const double share = debt < options_.grace ? debt / options_.grace : 1;
  const Screw V = mean_V_ + share * share * (V_ - mean_V_), WV = Scaled(weight_, V);
  const double speed2 = Power(WV, V);
  if (speed2 >= kAtRest) {
    const double driving =
        std::max(0.0, Power(F, V)) / (speed2 + (1 - share) * SlowSpeed2(F, options_));
    const double alpha = std::min(debt / (period_ * speed2), max_damping_);
    F -= share * (driving + alpha) * WV;
  }
  const Screw change = F - wanted;
  return Power(change, change) > 0;
}

}  // namespace vmech
