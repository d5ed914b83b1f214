#pragma once

#include <array>
#include <variant>

#include "vmech/base/pose.h"
#include "vmech/hw_interface/estimation/estimators.h"

namespace vmech {

enum class EstimatorKind { kKalman, kQuadraticFit, kFiniteDifferences, kAdaptiveWindow };

struct PoseEstimatorOptions {
  EstimatorKind kind = EstimatorKind::kKalman;
  double jerk_density = 1e2;          ///< kKalman, positions [m^2/s^5], in [1e-6, 1e12]
  double angular_jerk_density = 1e4;  ///< kKalman, rotations [rad^2/s^5], in [1e-6, 1e12]
  int window = 20;                    ///< kQuadraticFit and kAdaptiveWindow [samples], 3..64
};

/// Twist and acceleration of a frame from its poses at a fixed period: an estimator for each of
/// x, y, z, and for the components of its rotation, which are summed up from step to step as
/// log(R_k R_k-1') in world axes, so that no angle has a limit. No allocation.
class PoseEstimator {
 public:
  /// `resolution` of a position [m] and a rotation [rad], > 0. @throws as the estimators.
  PoseEstimator(const PoseEstimatorOptions& options, double period, double resolution,
                double angular_resolution);

  void Reset() noexcept;
  /// The pose after `periods` periods, 1 or more; in between it is taken to have moved evenly.
  void Update(const Posed& X_WB, int periods) noexcept;

  const Vector6d& V() const noexcept { return V_; }  ///< [v; w] at Bo, world axes
  const Vector6d& A() const noexcept { return A_; }  ///< [a; alpha]

 private:
  using Estimator =
      std::variant<KalmanEstimator<>, QuadraticFit, FiniteDifferences, AdaptiveWindow>;
  static Estimator Make(const PoseEstimatorOptions& options, double period, double resolution,
                        double jerk_density);

  std::array<Estimator, 6> estimators_;
  bool started_ = false;
  Posed X_last_;
  Vector6d displacement_ = Vector6d::Zero();  // position from the origin; rotation summed up
  Vector6d V_ = Vector6d::Zero(), A_ = Vector6d::Zero();
};

}  // namespace vmech
