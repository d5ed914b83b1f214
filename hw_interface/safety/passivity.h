#pragma once

#include "vmech/base/screw.h"
#include "vmech/hw_interface/masters/device_info.h"

namespace vmech {

/// How the passivity controller keeps account of energy.
struct PassivityOptions {
  bool enabled = true;  ///< false: the energy is observed, the wrench left alone
  /// Dissipation that may be kept as credit [J], in [0, 10]. Without a limit a long smooth motion
  /// would pay for a later instability. Raise it if the controller acts in sound motions.
  double credit = 2e-3;
  /// Lever that weighs rotations against translations [m], in [0.001, 10].
  double lever = 0.1;
  /// Debt up to which the controller acts in proportion, and leaves the wrench at rest alone [J],
  /// in [0, 1]. Encoder steps behind a stiff spring look like energy: raise it if sound motions
  /// feel dull; absurd gains then trip sooner.
  double grace = 0;
  /// Debt that is forgiven per second [W], in [0, 10], for the same reason.
  double forgiven = 0;
  /// Debt beyond the grace at which nothing but damping is left of the wrench [J], in [1e-4, 100].
  double largest_debt = 0.1;

  /// @throws std::invalid_argument naming field, value and range.
  void Validate() const;
};

/// The most damping that a handle of this mass [kg] or [kg m^2] takes without being thrown back,
/// m / (2 T + 4 delay), T not below a millisecond [N s/m] or [N m s/rad].
double MostDamping(double mass, const DeviceInfo& info) noexcept;

/// Time-domain passivity observer and controller at the handle [Hannaford & Ryu 2002]. The hand may
/// get back what it has given and no more:
///
///   E_k = E_k-1 - F_k-1 . dx_k + b |dx_k|^2 / T - (S_k - S_k-1)  >= 0,
///
/// dx_k = x_k - x_k-1 the measured motion, F the wrench at work meanwhile, b the handle's own
/// damping, which pays for what sampling makes of a stiff spring, S the energy that the virtual
/// mechanism says it stores (kinetic, potential, springs; constant if unknown); a debt is forgiven
/// slowly. While E < 0, by more than rounding, the wrench loses its part along the motion that
/// would drive the hand, gains damping, and fades with what the debt has beyond the grace E_g,
///
///   F <- f F - s (max(0, f F'V)/(V'WV + (1 - s) v^2) + alpha) W V,   W = diag(1, lever^2),
///   s = min(1, -E/E_g),   f = 1 + min(0, E + E_g)/E_largest,   f |F| v the power forgiven,
///
/// alpha = -E / (T V'WV), at most what the handle's mass takes without being thrown back: m / (2 T
/// + 4 delay), T not below a millisecond. V is the twist of the last sample, or over a millisecond;
/// within the grace the less of it, and the more of its mean over 5 ms, the smaller the debt:
/// encoder steps at rest are no motion.
class PassivityController {
 public:
  /// @throws std::invalid_argument as Validate.
  PassivityController(const PassivityOptions& options, const DeviceInfo& info);

  /// Forgets the energy; the next stored energy is the new zero.
  void Reset() noexcept;
  /// Another mechanism or grasp from now on: the next stored energy is the new zero, debts stay.
  void ForgetStoredEnergy() noexcept { knows_stored_ = false; }
  /// What happened in the `elapsed` [s] > 0 since the last sample: the wrench at work about Ho, the
  /// handle's displacement dX = [dp; dr], the virtual side's stored energy now.
  void Observe(const Screw& F_Ho_D, const Screw& dX, double elapsed, double stored_energy) noexcept;
  /// Makes of a wrench the one that keeps the peace for the next period. True if it is another.
  bool Control(Screw* F_Ho_D) const noexcept;

  double energy() const noexcept { return energy_; }  ///< E [J], at most the credit
  const Screw& V() const noexcept { return V_; }      ///< the handle's, of the last millisecond

 private:
  PassivityOptions options_;
  double period_;
  double max_damping_;  // alpha [N s/m]
  Screw weight_;
  Screw own_damping_;  // b
  Screw V_, mean_V_;
  double energy_ = 0;
  double stored_ = 0;
  bool knows_stored_ = false;
};

}  // namespace vmech
