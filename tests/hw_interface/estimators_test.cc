#include "vmech/hw_interface/estimation/estimators.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace vmech {
namespace {

constexpr double kPeriod = 1e-3;

/// A hand's motion in radians: q = 0.3 sin 2 pi t + 0.03 sin(2 pi 3.7 t + 0.4).
MotionEstimate Truth(double t) {
  MotionEstimate sum;
  const auto add = [&](double amplitude, double hertz, double phase) {
    const double w = 2 * std::numbers::pi * hertz;
    sum.x += amplitude * std::sin(w * t + phase);
    sum.v += amplitude * w * std::cos(w * t + phase);
    sum.a -= amplitude * w * w * std::sin(w * t + phase);
  };
  add(0.3, 1, 0);
  add(0.03, 3.7, 0.4);
  return sum;
}

struct Error {
  double v = 0, a = 0;  // RMS, in percent of the signal's RMS
};

/// Over 10 s behind an encoder, after half a second.
template <typename Estimator>
Error ErrorBehindEncoder(Estimator estimator, int bits) {
  const double count = std::ldexp(2 * std::numbers::pi, -bits);
  double v_error = 0, a_error = 0, v_size = 0, a_size = 0;
  for (int k = 0; k < 10'500; ++k) {
    const MotionEstimate truth = Truth(k * kPeriod);
    const MotionEstimate e = estimator.Update(count * std::round(truth.x / count));
    if (k < 500) continue;
    v_error += std::pow(e.v - truth.v, 2);
    a_error += std::pow(e.a - truth.a, 2);
    v_size += truth.v * truth.v;
    a_size += truth.a * truth.a;
  }
  return {100 * std::sqrt(v_error / v_size), 100 * std::sqrt(a_error / a_size)};
}

double Count(int bits) {
  return std::ldexp(2 * std::numbers::pi, -bits);
}

// The figures of an independent prototype for this motion, in percent; quantisation errors of two
// implementations differ by a few percent of themselves.
constexpr double kAgreement = 0.1;
#define EXPECT_ABOUT(value, figure) EXPECT_NEAR(value, figure, kAgreement*(figure) + 0.05)

TEST(Estimators, FiniteDifferencesLoseTheAccelerationBehind16Bits) {
  const Error error = ErrorBehindEncoder(FiniteDifferences(kPeriod), 16);
  EXPECT_ABOUT(error.v, 2.8);
  EXPECT_ABOUT(error.a, 487);
}

TEST(Estimators, KalmanFilterKeepsAccelerationWithinAFifth) {
  const Error error = ErrorBehindEncoder(KalmanEstimator<>(kPeriod, Count(16)), 16);
  EXPECT_ABOUT(error.v, 0.7);
  EXPECT_ABOUT(error.a, 20);
}

TEST(Estimators, QuadraticFitOver20MillisecondsIsAsGood) {
  const Error error = ErrorBehindEncoder(QuadraticFit(kPeriod, 20), 16);
  EXPECT_ABOUT(error.v, 0.8);
  EXPECT_ABOUT(error.a, 19);
}

TEST(Estimators, AdaptiveWindowHalvesTheNoiseOfSlowVelocity) {
  const Error error = ErrorBehindEncoder(AdaptiveWindow(kPeriod, Count(16) / 2), 16);
  EXPECT_ABOUT(error.v, 2.3);
}

TEST(Estimators, CoarserEncoderCosts) {
  EXPECT_ABOUT(ErrorBehindEncoder(FiniteDifferences(kPeriod), 13).a, 3917);
  EXPECT_ABOUT(ErrorBehindEncoder(KalmanEstimator<>(kPeriod, Count(13)), 13).a, 30);
  EXPECT_ABOUT(ErrorBehindEncoder(QuadraticFit(kPeriod, 20), 13).a, 28);
  EXPECT_ABOUT(ErrorBehindEncoder(AdaptiveWindow(kPeriod, Count(13) / 2), 13).v, 5.1);
}

/// Estimate of x = 0.7 + 2 t + 3 t^2 at the end of a second.
template <typename Estimator>
MotionEstimate OfParabola(Estimator estimator) {
  MotionEstimate e;
  for (int k = 0; k <= 1000; ++k) {
    const double t = k * kPeriod;
    e = estimator.Update(0.7 + 2 * t + 3 * t * t);
  }
  return e;
}

TEST(Estimators, KnowAParabolaExactly) {
  constexpr double kRounding = 1e-6;  // of x near 6 over T^2, divided by the window
  const MotionEstimate fit = OfParabola(QuadraticFit(kPeriod, 20));
  const MotionEstimate kalman = OfParabola(KalmanEstimator<>(kPeriod, Count(16)));
  for (const MotionEstimate& e : {fit, kalman}) {
    EXPECT_NEAR(e.x, 5.7, kRounding);
    EXPECT_NEAR(e.v, 8, kRounding);
    EXPECT_NEAR(e.a, 6, 1e-4);
  }
}

TEST(Estimators, FiniteDifferencesLagByHalfASample) {
  const MotionEstimate e = OfParabola(FiniteDifferences(kPeriod));
  EXPECT_NEAR(e.v, 8 - 0.5 * 6 * kPeriod, 1e-9);
  EXPECT_NEAR(e.a, 6, 1e-6);
}

TEST(AdaptiveWindow, UsesTheWholeWindowOfASteadyMotion) {
  // Noise that alternates by its bound: only a long window averages it away.
  AdaptiveWindow estimator(kPeriod, 1e-4, 16);
  MotionEstimate e;
  for (int k = 0; k < 200; ++k) e = estimator.Update(0.5 * k * kPeriod + (k % 2 ? 7e-5 : -7e-5));
  EXPECT_NEAR(e.v, 0.5, 0.012);  // a difference of two samples would be off by 0.14
}

TEST(AdaptiveWindow, FollowsAnImpactAtOnce) {
  AdaptiveWindow estimator(kPeriod, 1e-5, 16);
  for (int k = 0; k < 100; ++k) estimator.Update(1e-3 * k);
  MotionEstimate e;
  for (int k = 1; k <= 2; ++k) e = estimator.Update(0.099 - 2e-3 * k);
  EXPECT_NEAR(e.v, -2, 1e-9);
}

TEST(KalmanEstimator, GainsSolveTheRiccatiEquation) {
  // The filter's poles lie within the unit circle: an error in the state dies out.
  KalmanEstimator<> estimator(kPeriod, Count(16));
  estimator.Update(1);
  MotionEstimate e;
  for (int k = 0; k < 1000; ++k) e = estimator.Update(0);
  EXPECT_NEAR(e.x, 0, 1e-9);
  EXPECT_NEAR(e.v, 0, 1e-7);
  EXPECT_NEAR(e.a, 0, 1e-5);
}

TEST(Estimators, StartAtRestAfterAReset) {
  KalmanEstimator<> estimator(kPeriod, Count(16));
  for (int k = 0; k < 10; ++k) estimator.Update(k);
  estimator.Reset();
  const MotionEstimate e = estimator.Update(5);
  EXPECT_EQ(e.x, 5);
  EXPECT_EQ(e.v, 0);
  EXPECT_EQ(e.a, 0);
}

}  // namespace
}  // namespace vmech
