#pragma once

#include <array>
#include <cstdint>

namespace vmech {

/// Velocity and acceleration of one coordinate from its samples x_k at a fixed period T. All are
/// O(window) at most, without allocation. The first sample after construction or Reset is taken to
/// be at rest. What each leaves of a real motion behind a 16-bit encoder at 1 kHz is measured in
/// estimators_test.cc.
template <typename Coordinate>
struct MotionEstimateOf {
  Coordinate x{}, v{}, a{};  ///< coordinate, velocity, acceleration
};
/// The estimate of a single coordinate.
using MotionEstimate = MotionEstimateOf<double>;

/// The paper's way: v = (x_k - x_k-1)/T, a = (v_k - v_k-1)/T. An encoder step D gives an
/// acceleration of D/T^2.
class FiniteDifferences {
 public:
  explicit FiniteDifferences(double period);   ///< T of the samples [s], > 0
  void Reset() noexcept { started_ = false; }  ///< the next sample is the first
  MotionEstimate Update(double x) noexcept;    ///< a sample [m] or [rad]

 private:
  double rate_;
  bool started_ = false;
  MotionEstimate last_;
};

/// The gains k [3] of a KalmanEstimator. `resolution` [unit] of the sensor, R = resolution^2 / 12,
/// in [1e-12, 1]; `jerk_density` [unit^2/s^5] in [1e-6, 1e12]: raise it for faster motion, lower it
/// for less noise. 1e4 suits a hand that moves radians.
std::array<double, 3> KalmanGains(double period, double resolution, double jerk_density);

/// Steady-state Kalman filter of the state (x, v, a) driven by white jerk of density q_j, measured
/// with variance R:
///
///   F = [1 T T^2/2; 0 1 T; 0 0 1],   Q = q_j [T^5/20 T^4/8 T^3/6; . T^3/3 T^2/2; . . T],
///   s <- F s,   s <- s + k (x - s_x).
///
/// The gains k depend on q_j / R and T alone and are found once. A Coordinate is a number, or an
/// array of those that share them.
template <typename Coordinate = double>
class KalmanEstimator {
 public:
  /// Parameters as those of KalmanGains.
  KalmanEstimator(double period, double resolution, double jerk_density = 1e4)
      : period_(period), gain_(KalmanGains(period, resolution, jerk_density)) {}
  void Reset() noexcept { started_ = false; }  ///< the next sample is the first
  /// A sample [m] or [rad].
  const MotionEstimateOf<Coordinate>& Update(const Coordinate& x) noexcept {
    if (!started_) {
      started_ = true;
      return s_ = {x, 0 * x, 0 * x};
    }
    s_.x += period_ * (s_.v + 0.5 * period_ * s_.a);
    s_.v += period_ * s_.a;
    const Coordinate innovation = x - s_.x;
    s_.x += gain_[0] * innovation;
    s_.v += gain_[1] * innovation;
    s_.a += gain_[2] * innovation;
    return s_;
  }

 private:
  double period_;
  std::array<double, 3> gain_;
  bool started_ = false;
  MotionEstimateOf<Coordinate> s_;
};

/// Least-squares parabola through the last n samples, its value and derivatives at the newest:
/// three fixed filters of n coefficients.
class QuadraticFit {
 public:
  static constexpr int kMaxWindow = 64;  ///< samples
  /// `window` samples, 3..64; 20 at 1 kHz. Longer is smoother and lags more.
  QuadraticFit(double period, int window);
  void Reset() noexcept { count_ = 0; }      ///< the next sample is the first
  MotionEstimate Update(double x) noexcept;  ///< a sample [m] or [rad]

 private:
  int window_;
  int count_ = 0;
  int newest_ = 0;
  std::array<double, kMaxWindow> samples_{}, value_{}, slope_{}, curvature_{};
};

/// First-order adaptive windowing [Janabi-Sharifi, Hayward & Chen 2000], best fit: the slope of the
/// least-squares line over the longest window whose samples all lie within `noise` of it. Short in
/// fast motion, long in slow: velocity for damping terms. Its acceleration is always zero.
class AdaptiveWindow {
 public:
  static constexpr int kMaxWindow = 64;  ///< samples
  /// `noise`: largest error of a sample, half an encoder step, in [1e-12, 1] [unit]. `window`
  /// samples, 2..64.
  AdaptiveWindow(double period, double noise, int window = 16);
  void Reset() noexcept { count_ = 0; }      ///< the next sample is the first
  MotionEstimate Update(double x) noexcept;  ///< a sample [m] or [rad]

 private:
  double Sample(int age) const noexcept { return samples_[(newest_ - age) & (kMaxWindow - 1)]; }
  bool Fits(int n, double* slope) const noexcept;

  double period_, noise_;
  int window_;
  int count_ = 0;
  int newest_ = 0;
  std::array<double, kMaxWindow> samples_{};
};

}  // namespace vmech
