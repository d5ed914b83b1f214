#include "vmech/hw_interface/estimation/estimators.h"

#include <Eigen/Core>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "vmech/base/check_range.h"

namespace vmech {
namespace {

using Matrix3 = Eigen::Matrix3d;

constexpr double kShortestPeriod = 1e-6, kLongestPeriod = 1;  // [s]

double CheckedPeriod(double period) {
  CheckRange("estimator", "period", period, kShortestPeriod, kLongestPeriod);
  return period;
}

/// k = P_ e_x / (P_xx + R) with P the fixed point of P = F (I - k e_x') P F' + Q. In units of T and
/// of the sensor's noise, where the matrices are well scaled.
std::array<double, 3> SteadyGains(double period, double variance, double jerk_density) {
  constexpr int kMostIterations = 200'000;
  constexpr double kSettled = 1e-14;
  const double q = jerk_density * std::pow(period, 5) / variance;
  Matrix3 F, Q;
  F << 1, 1, 0.5, 0, 1, 1, 0, 0, 1;
  Q << 1.0 / 20, 1.0 / 8, 1.0 / 6, 1.0 / 8, 1.0 / 3, 1.0 / 2, 1.0 / 6, 1.0 / 2, 1;
  Q *= q;
  Matrix3 P = Matrix3::Identity();
  Eigen::Vector3d k = Eigen::Vector3d::Zero();
  for (int i = 0; i < kMostIterations; ++i) {
    const Eigen::Vector3d next = P.col(0) / (P(0, 0) + 1);
    const double change = (next - k).cwiseAbs().maxCoeff();
    k = next;
    if (i > 0 && change < kSettled * k.cwiseAbs().minCoeff()) break;
    P = (F * (P - k * P.row(0)) * F.transpose() + Q).eval();
    P = 0.5 * (P + P.transpose()).eval();
  }
  return {k[0], k[1] / period, k[2] / (period * period)};
}

}  // namespace

FiniteDifferences::FiniteDifferences(double period) : rate_(1 / CheckedPeriod(period)) {}

MotionEstimate FiniteDifferences::Update(double x) noexcept {
  if (!started_) {
    started_ = true;
    return last_ = {x, 0, 0};
  }
  const double v = (x - last_.x) * rate_;
  return last_ = {x, v, (v - last_.v) * rate_};
}

std::array<double, 3> KalmanGains(double period, double resolution, double jerk_density) {
  CheckedPeriod(period);
  CheckRange("KalmanEstimator", "resolution", resolution, 1e-12, 1);
  CheckRange("KalmanEstimator", "jerk_density", jerk_density, 1e-6, 1e12);
  return SteadyGains(period, resolution * resolution / 12, jerk_density);
}

QuadraticFit::QuadraticFit(double period, int window) : window_(window) {
  CheckedPeriod(period);
  CheckRange("QuadraticFit", "window", window, 3, kMaxWindow);
  // Normal equations of x(t) = c0 + c1 t + c2 t^2 at t = 0, -T, ..., -(n-1) T, in units of n T.
  const double span = window * period;
  Matrix3 N = Matrix3::Zero();
  for (int age = 0; age < window; ++age) {
    const double t = -age * period / span;
    const Eigen::Vector3d row(1, t, t * t);
    N += row * row.transpose();
  }
  const Matrix3 inverse = N.inverse();
  for (int age = 0; age < window; ++age) {
    const double t = -age * period / span;
    const Eigen::Vector3d c = inverse * Eigen::Vector3d(1, t, t * t);
    value_[age] = c[0];
    slope_[age] = c[1] / span;
    curvature_[age] = 2 * c[2] / (span * span);
  }
}

MotionEstimate QuadraticFit::Update(double x) noexcept {
  if (count_ == 0) samples_.fill(x);
  count_ = 1;
  newest_ = (newest_ + 1) & (kMaxWindow - 1);
  samples_[newest_] = x;
  // The filters sum to 1, 0 and 0: relative to x they keep their precision far from the origin.
  MotionEstimate fit{x, 0, 0};
  for (int age = 0; age < window_; ++age) {
    const double sample = samples_[(newest_ - age) & (kMaxWindow - 1)] - x;
    fit.x += value_[age] * sample;
    fit.v += slope_[age] * sample;
    fit.a += curvature_[age] * sample;
  }
  return fit;
}

AdaptiveWindow::AdaptiveWindow(double period, double noise, int window)
    : period_(CheckedPeriod(period)), noise_(noise), window_(window) {
  CheckRange("AdaptiveWindow", "noise", noise, 1e-12, 1);
  CheckRange("AdaptiveWindow", "window", window, 2, kMaxWindow);
}

/// The best line through the newest n + 1 samples, and whether all of them lie within the noise.
bool AdaptiveWindow::Fits(int n, double* slope) const noexcept {
  double mean = 0, moment = 0;
  for (int age = 0; age <= n; ++age) {
    mean += Sample(age);
    moment += (n - 2 * age) * Sample(age);
  }
  mean /= n + 1;
  // b = sum (n - 2 i) x_{k-i} / (T n (n + 1) (n + 2) / 6)
  const double per_sample = moment / (n * (n + 1.0) * (n + 2.0) / 6);
  *slope = per_sample / period_;
  for (int age = 0; age <= n; ++age) {
    const double line = mean + per_sample * (0.5 * n - age);
    if (std::abs(Sample(age) - line) > noise_) return false;
  }
  return true;
}

MotionEstimate AdaptiveWindow::Update(double x) noexcept {
  newest_ = (newest_ + 1) & (kMaxWindow - 1);
  samples_[newest_] = x;
  count_ = std::min(count_ + 1, window_);
  MotionEstimate estimate{x, 0, 0};
  for (int n = 1; n < count_; ++n) {
    double slope;
    const bool fits = Fits(n, &slope);
    if (!fits && n > 1) break;
    estimate.v = slope;
  }
  return estimate;
}

}  // namespace vmech
