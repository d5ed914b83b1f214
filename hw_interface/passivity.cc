#include "vmech/hw_interface/passivity.h"

#include <algorithm>

#include "vmech/solvers/stopping_rule.h"

namespace vmech {

void PassivityOptions::Validate() const {
  CheckRange("PassivityOptions", "credit", credit, 0, 10);
  CheckRange("PassivityOptions", "lever", lever, 1e-3, 10);
  CheckRange("PassivityOptions", "grace", grace, 0, 1);
  CheckRange("PassivityOptions", "forgiven", forgiven, 0, 10);
  CheckRange("PassivityOptions", "largest_debt", largest_debt, 1e-4, 100);
}

PassivityController::PassivityController(const PassivityOptions& options, const DeviceInfo& info)
    : options_(options), period_(info.period) {
  options.Validate();
  const double lever2 = options.lever * options.lever;
  own_damping_.head<3>().setConstant(info.linear.damping);
  own_damping_.tail<3>().setConstant(info.angular.damping);
  weight_ << 1, 1, 1, lever2, lever2, lever2;
  // The lighter of the two, as a mass: the angular one turns at the lever.
  double mass = info.linear.mass;
  if (info.angular.mass > 0) mass = std::min(mass, info.angular.mass / lever2);
  max_damping_ = mass / (2 * info.period + 4 * info.delay);
}

void PassivityController::Reset() noexcept {
  energy_ = 0;
  V_.setZero();
  mean_V_.setZero();
  knows_stored_ = false;
}

void PassivityController::Observe(const Vector6d& F_Ho_D, const Vector6d& dX, double elapsed,
                                  double stored_energy) noexcept {
  if (!knows_stored_) stored_ = stored_energy;
  knows_stored_ = true;
  const double own_loss = dX.dot(own_damping_.cwiseProduct(dX)) / elapsed;
  energy_ += own_loss - F_Ho_D.dot(dX) - (stored_energy - stored_);
  if (energy_ < 0) energy_ = std::min(0.0, energy_ + options_.forgiven * elapsed);
  energy_ = std::min(energy_, options_.credit);
  stored_ = stored_energy;
  constexpr double kMean = 5e-3;  // [s]
  V_ = dX / elapsed;
  mean_V_ += std::min(1.0, elapsed / kMean) * (V_ - mean_V_);
}

Vector6d PassivityController::Control(const Vector6d& F_Ho_D) const noexcept {
  constexpr double kAtRest = 1e-12;  // [m^2/s^2]: no motion that could dissipate
  if (!options_.enabled || energy_ >= 0) return F_Ho_D;
  const double debt = -energy_;
  const double beyond = std::max(0.0, debt - options_.grace);
  const Vector6d faded = std::max(0.0, 1 - beyond / options_.largest_debt) * F_Ho_D;
  const double share = debt < options_.grace ? debt / options_.grace : 1;
  const Vector6d V = mean_V_ + share * (V_ - mean_V_);
  const double speed2 = V.dot(weight_.cwiseProduct(V));
  if (speed2 < kAtRest) return faded;
  const double driving = std::max(0.0, faded.dot(V) / speed2);
  const double alpha = std::min(debt / (period_ * speed2), max_damping_);
  return faded - share * (driving + alpha) * weight_.cwiseProduct(V);
}

}  // namespace vmech
