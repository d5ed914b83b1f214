#pragma once

#include <array>
#include <variant>
#include <vector>

#include "vmech/base/eigen.h"
#include "vmech/hw_interface/estimation/estimators.h"

namespace vmech {

using Eigen::VectorXd;

/// How a motion is found in samples; KalmanEstimator and its neighbours say how each works.
enum class EstimatorKind {
  kObserver,           ///< by a HandObserver, where the device has an arm; else kKalman
  kKalman,             ///< state (x, v, a)
  kQuadraticFit,       ///< parabola through the last samples
  kAdaptiveWindow,     ///< line through as many as it fits: velocity alone
  kFiniteDifferences,  ///< the paper's
};

/// What a coordinate estimator takes for given of the motion.
struct EstimatorOptions {
  EstimatorKind kind = EstimatorKind::kObserver;  ///< the filter
  double jerk_density = 1e2;                      ///< kKalman, lengths [m^2/s^5], in [1e-6, 1e12]
  double angular_jerk_density = 1e4;              ///< kKalman, angles [rad^2/s^5], in [1e-6, 1e12]
  int window = 20;  ///< kQuadraticFit [samples], 3..64, and kAdaptiveWindow, 2..64
};

/// Velocities and accelerations of coordinates from their steps at a fixed period: an estimator for
/// each. Steps are summed up, so that no angle has a limit. No allocation after construction.
class CoordinateEstimator {
 public:
  /// A length or an angle, and the step in which it is known [m] or [rad], > 0.
  struct Coordinate {
    bool is_angle;      ///< counted in [rad], not [m]
    double resolution;  ///< step of the encoder [m] or [rad]
  };
  /// @throws std::invalid_argument as the estimators.
  CoordinateEstimator(const EstimatorOptions& options, double period,
                      const std::vector<Coordinate>& coordinates);

  void Reset() noexcept;  ///< the next sample is the first
  /// Takes the displacement [size] in the last `periods` periods, 1 or more, over which it is
  /// spread evenly; zero for the first sample.
  void Update(const VectorXd& step, int periods) noexcept;

  const VectorXd& v() const noexcept { return v_; }  ///< [size] velocities [m/s, rad/s]
  const VectorXd& a() const noexcept { return a_; }  ///< [size] accelerations [m/s^2, rad/s^2]

 private:
  using Estimator =
      std::variant<KalmanEstimator<>, QuadraticFit, FiniteDifferences, AdaptiveWindow>;

  std::vector<Estimator> estimators_;
  VectorXd displacement_, v_, a_;
};

}  // namespace vmech
