#pragma once

#include <Eigen/Cholesky>
#include <array>

#include "vmech/hw_interface/arm/arm_model.h"
#include "vmech/hw_interface/masters/master.h"

namespace vmech {

/// How a hand observer follows the hand, and what it takes for given of the arm.
struct HandObserverOptions {
  /// How fast it follows what the hand does of itself [1/s], 0 or in [30, 1000]; 0: no observer.
  /// Lower is quieter, and relies more on the arm's model.
  double bandwidth = 120;
  /// c: the handle is taken for so much lighter than the arm's model says, in [0, 4]. More adds
  /// damping to what a spring renders; for a rendered inertia it is 1.
  double lighter = 1;

  /// @throws std::invalid_argument naming field, value and range.
  void Validate() const;
};

/// Pose and twist of an arm's handle from its samples and from the wrench that the arm itself
/// exerts: what a stiff coupling does to the handle is then known without a lag, and only what the
/// hand does has to be found in samples that come in encoder steps. Per axis a steady-state Kalman
/// filter of the state (x, v, d), d the acceleration by the hand,
///
///   v' = c Y F + d,   d' white noise,   Y = J M^-1 J' of the arm's model,
///
/// F the wrench at work since the last sample, in place of an acceleration that is all unknown
/// (KalmanEstimator). c > 1: the handle is taken for lighter than it is, which adds damping and
/// leaves room for a hand that moves along and a model that is not exact. Y is found anew every 0.2
/// s. No allocation after construction.
class HandObserver {
 public:
  /// True if the device states its arm, senses the arm's joints and takes forces or torques.
  static bool Suits(const DeviceInfo& info);

  /// @throws std::invalid_argument as Validate, or if the device does not suit.
  HandObserver(const HandObserverOptions& options, const DeviceInfo& info);

  void Reset() noexcept { started_ = false; }  ///< the next sample is the first
  /// A fresh sample, `periods` after the last, 1 or more.
  void Update(const MasterState& state, const Vector6d& F_Ho_D, int periods) noexcept;

  /// How much of the pose and the twist is the filter's, in [0, 1]. While a joint leans on its
  /// stop, of which the model knows nothing, or the filter is off the samples by more than their
  /// resolution, it goes to zero: the samples as they are, and their differences.
  double trust() const noexcept { return trust_; }
  const MovingFrame& hand_D() const noexcept { return hand_; }  ///< the handle in D
  Posed X_DH() const noexcept;                                  ///< its pose there
  Vector6d V_DH() const noexcept;                               ///< [v; w] of Ho and H, axes of D

 private:
  static constexpr int kMostPeriods = 16;  // a longer gap counts as this

  void FindMobility(const MasterState& state) noexcept;
  bool AtStop(const MasterState& state) const noexcept;

  double period_, lighter_;
  std::array<double, 3> gain_;
  std::array<double, kMostPeriods + 1> new_share_;  // of a difference over so many periods
  ArmModel arm_;
  JointArray lower_, upper_;  // stops of the joints
  Eigen::LLT<MatrixXd> factor_;
  MatrixXd yielding_;              // M^-1 J' [joints, 6]
  std::array<Screw, 6> mobility_;  // c Y, column by column
  int until_mobility_ = 0;         // samples
  double trust_ = 1;
  Screw resolution_;  // the filter's pose is never further off than this
  bool started_ = false;
  Frame X_last_;
  Screw displacement_;  // measured since the start, rotations summed up
  Screw x_, v_, d_;
  Screw differences_;
  MovingFrame hand_;
};

}  // namespace vmech
