#include "vmech/hw_interface/estimation/estimators.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <numbers>

namespace vmech::estimators_test {
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

/// A handle of one freedom behind an encoder, which renders the inertia M by one way or another to
/// an acceleration. docs/haptic.md has the table.
enum class Way { kDifferences, kKalman, kRollOff, kObserverRollOff, kImplicit };

class RenderedMass {
 public:
  static constexpr double kHandle = 0.82, kDamping = 3, kStep = 3e-5, kTime = 9e-3;

  RenderedMass(Way way, double ratio, double bandwidth)
      : way_(way), mass_(ratio * kHandle), kalman_(kPeriod, kStep, 100), differences_(kPeriod) {
    constexpr double kUnit = 1e-3;  // gains depend on bandwidth times period alone
    gain_ = KalmanGains(kPeriod, kUnit, std::pow(bandwidth, 6) * kPeriod * kUnit * kUnit / 12);
  }

  /// The force on the handle for the next period, from a sample.
  double Force(double x) {
    if (way_ == Way::kDifferences) return force_ = -mass_ * differences_.Update(x).a;
    if (way_ == Way::kKalman) return force_ = -mass_ * kalman_.Update(x).a;
    if (way_ == Way::kRollOff) return RollOff(differences_.Update(x).v);
    const double a = d_ + force_ / kHandle;
    x_ += kPeriod * (v_ + 0.5 * kPeriod * a);
    v_ += kPeriod * a;
    const double innovation = x - x_;
    x_ += gain_[0] * innovation;
    v_ += gain_[1] * innovation;
    d_ += gain_[2] * innovation;
    if (way_ == Way::kObserverRollOff) return RollOff(v_);
    return force_ = -mass_ * d_ / (1 + mass_ / kHandle);  // F = -M (d + F/m)
  }
  double mass() const { return mass_; }

 private:
  double RollOff(double v) {
    const double rate = (v - u_) / (kTime + kPeriod);
    u_ += kPeriod * rate;
    return force_ = -mass_ * rate;
  }

  Way way_;
  double mass_;
  std::array<double, 3> gain_;
  KalmanEstimator<> kalman_;
  FiniteDifferences differences_;
  double x_ = 0, v_ = 0, d_ = 0, u_ = 0, force_ = 0;
};

/// Does the handle come to rest with nobody or somebody at it?
bool ComesToRest(RenderedMass rendered, double hand_mass, double stiffness, double damping) {
  constexpr int kSubsteps = 10;
  double x = 0, v = 0.02;
  for (int k = 0; k < 3000; ++k) {
    const double force = std::clamp(rendered.Force(x), -1e3, 1e3);
    for (int i = 0; i < kSubsteps; ++i) {
      v += kPeriod / kSubsteps * (force - stiffness * x - (RenderedMass::kDamping + damping) * v) /
           (RenderedMass::kHandle + hand_mass);
      x += kPeriod / kSubsteps * v;
    }
  }
  return std::abs(rendered.Force(x)) < 1e-2 * std::max(1.0, rendered.mass());
}

double LargestStableRatio(Way way, double bandwidth = 250) {
  double largest = 0;
  for (double ratio = 0.05; ratio < 300; ratio *= 1.1) {
    const RenderedMass rendered(way, ratio, bandwidth);
    const bool stable = ComesToRest(rendered, 0, 0, 0) && ComesToRest(rendered, 0.277, 34, 2.28) &&
                        ComesToRest(rendered, 0.554, 135, 6.45) &&
                        ComesToRest(rendered, 0.554, 1350, 20.4);
    if (!stable) break;
    largest = ratio;
  }
  return largest;
}

/// Force over that of the true inertia at 3 Hz, 10 mm to both sides, behind the encoder.
std::complex<double> Felt(Way way, double ratio, double bandwidth = 250) {
  RenderedMass rendered(way, ratio, bandwidth);
  constexpr double kRate = 2 * std::numbers::pi * 3, kStroke = 0.01, kStep = RenderedMass::kStep;
  std::complex<double> felt = 0, expected = 0;
  for (int k = 0; k < 4000; ++k) {
    const double x = kStroke * std::sin(kRate * k * kPeriod);
    const std::complex<double> phase = std::polar(1.0, -kRate * k * kPeriod);
    const double force = rendered.Force(kStep * std::round(x / kStep));
    if (k < 2000) continue;
    felt += phase * force;
    expected += phase * rendered.mass() * kRate * kRate * x;
  }
  return felt / expected;
}

double Degrees(const std::complex<double>& felt) {
  return std::arg(felt) * 180 / std::numbers::pi;
}

TEST(RenderedMass, IsTwiceTheHandlesByDifferencesAndManyTimesByARollOff) {
  EXPECT_NEAR(LargestStableRatio(Way::kDifferences), 2.1, 0.2);
  EXPECT_NEAR(LargestStableRatio(Way::kKalman), 2.7, 0.3);
  EXPECT_GT(LargestStableRatio(Way::kRollOff), 15);
  EXPECT_GT(LargestStableRatio(Way::kObserverRollOff), 15);
  EXPECT_GT(LargestStableRatio(Way::kImplicit), 250);
}

TEST(RenderedMass, IsFeltAt3HertzByARollOff) {
  for (const double ratio : {1.0, 5.0}) {
    const std::complex<double> felt = Felt(Way::kObserverRollOff, ratio);
    EXPECT_NEAR(felt.real(), 1, 0.05) << ratio;
    EXPECT_LT(std::abs(Degrees(felt)), 15) << ratio;
  }
}

TEST(RenderedMass, LagsTheMoreTheHeavierItIsWhereSolvedImplicitly) {
  EXPECT_LT(Degrees(Felt(Way::kImplicit, 1, 120)), -30);
  EXPECT_LT(Degrees(Felt(Way::kImplicit, 5, 600)), 1.8 * Degrees(Felt(Way::kImplicit, 1, 600)));
}

}  // namespace
}  // namespace vmech::estimators_test
