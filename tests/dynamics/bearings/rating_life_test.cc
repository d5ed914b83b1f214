#include "vmech/dynamics/bearings/rating_life.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <stdexcept>
#include <vector>

namespace vmech {
namespace {

constexpr double kRoundoff = 1e-12;
constexpr double kRpm = std::numbers::pi / 30;
constexpr auto kBall = BearingKind::kDeepGrooveBall;
constexpr auto kRoller = BearingKind::kCylindricalRoller;

double HoursAt(double C, double P, double rpm, BearingKind kind) {
  return HoursOf(BasicRatingLife(C, P, kind), rpm * kRpm);
}

Bearing Ball(double C0, double f0) {
  Bearing bearing;
  bearing.static_rating = C0;
  bearing.f0 = f0;
  return bearing;
}

// NTN general catalogue, example 1: 6208, printed "about 27 000 h".
TEST(BasicRatingLife, MatchesNtnExample1) {
  EXPECT_NEAR(HoursAt(32500, 3200, 650, kBall), 27000, 0.01 * 27000);  // two printed digits
  EXPECT_NEAR(HoursAt(32500, 3200, 650, kBall), 26861.826578776043, 1e-6);
}

// NSK rolling bearings, example 1: 6208, printed "about 29 000 h", fh = 3.88 (L10h = 500 fh^3).
TEST(BasicRatingLife, MatchesNskExample1) {
  const double hours = HoursAt(29100, 2500, 900, kBall);
  EXPECT_NEAR(hours, 29000, 0.01 * 29000);                      // two printed digits
  EXPECT_NEAR(std::cbrt(hours / 500), 3.88, 0.001 * 3.88 * 2);  // fn is rounded to .333
}

// NSK rolling bearings, example 2: printed C >= 31 380 N from tabulated (rounded) fh and fn.
TEST(RequiredDynamicRating, MatchesNskExample2) {
  const double life = 10000 / HoursOf(1, 1900 * kRpm);
  EXPECT_NEAR(RequiredDynamicRating(3000, life, kBall), 31380, 0.002 * 31380);
}

TEST(RequiredDynamicRating, InvertsBasicRatingLife) {
  for (BearingKind kind : {kBall, kRoller}) {
    const double C = RequiredDynamicRating(1234, 56.7, kind);
    EXPECT_NEAR(BasicRatingLife(C, 1234, kind), 56.7, kRoundoff * 1e2);
  }
}

// SKF general catalogue 17000 EN, rope sheave: 6207, printed 804 800 h.
TEST(BasicRatingLife, MatchesSkfRopeSheave) {
  EXPECT_NEAR(HoursAt(27000, 550, 2450, kBall), 804800, 50);  // four printed digits
}

// Jindal, Machine Design, ch. 18: P = X Fr + Y Fa, without and with a shock factor on Fr.
TEST(BasicRatingLife, MatchesJindalExample) {
  EXPECT_NEAR(BasicRatingLife(5590, 0.56 * 1250 + 1.2 * 625, kBall), 57.3, 0.05);
  EXPECT_NEAR(BasicRatingLife(5590, 1.2 * 0.56 * 1250 + 1.2 * 625, kBall), 43.46, 0.01);
}

// NTN general catalogue, example 4: two roller bearings, printed 1900, 7550 and together 1600 h.
TEST(SystemLife, MatchesNtnExample4) {
  const std::vector<double> lives{HoursAt(30500, 5980, 2000, kRoller),
                                  HoursAt(36000, 4670, 2000, kRoller)};
  EXPECT_NEAR(lives[0], 1900, 10);
  EXPECT_NEAR(lives[1], 7550, 10);
  EXPECT_NEAR(SystemLife(lives, WeibullSlope(kRoller)), 1600, 5);
}

TEST(SystemLife, OfEqualBearingsIsShortenedByTheWeibullSlope) {
  const std::vector<double> lives{1000, 1000};
  EXPECT_NEAR(SystemLife(lives, WeibullSlope(kBall)), 1000 * std::pow(2, -0.9), 1e-9);
}

TEST(SystemLife, IsThatOfTheLoadedBearingBesideAnUnloadedOne) {
  const std::vector<double> lives{1000, BasicRatingLife(1e4, 0, kBall)};
  EXPECT_NEAR(SystemLife(lives, WeibullSlope(kBall)), 1000, 1e-9);
}

// NTN general catalogue, example 2, prints e = 0.302 and Y = 1.443 for a 6208.
TEST(DeepGrooveFactors, GiveBothFiguresOfNtnExample2AtOneRelativeLoad) {
  const AxialFactors factors = DeepGrooveFactors(1.4145);
  EXPECT_NEAR(factors.e, 0.302, 5e-4);
  EXPECT_NEAR(factors.Y, 1.443, 5e-4);
}

TEST(DeepGrooveFactors, AreThoseOfTheTableAtItsRows) {
  EXPECT_NEAR(DeepGrooveFactors(0.345).e, 0.22, kRoundoff);
  EXPECT_NEAR(DeepGrooveFactors(2.07).Y, 1.31, kRoundoff);
  EXPECT_NEAR(DeepGrooveFactors(6.89).Y, 1.00, kRoundoff);
}

TEST(DeepGrooveFactors, KeepTheNearestRowOutsideTheTable) {
  EXPECT_EQ(DeepGrooveFactors(0).Y, 2.30);
  EXPECT_EQ(DeepGrooveFactors(0).e, 0.19);
  EXPECT_EQ(DeepGrooveFactors(100).Y, 1.00);
  EXPECT_EQ(DeepGrooveFactors(100).e, 0.44);
}

TEST(EquivalentDynamicLoad, FollowsThePrintedRuleOnBothSidesOfE) {
  const Bearing bearing = Ball(14000, 14);  // relative axial load = Fa / 1000
  EXPECT_EQ(EquivalentDynamicLoad(bearing, 10000, 1000), 10000);
  EXPECT_NEAR(EquivalentDynamicLoad(bearing, 1000, 1380), 0.56 * 1000 + 1.45 * 1380, 1e-9);
}

TEST(EquivalentDynamicLoad, NeverFallsWhenALoadGrows) {
  const Bearing bearing = Ball(14000, 14);
  for (double Fr = 0; Fr < 9000; Fr += 450) {
    for (double Fa = 0; Fa < 9000; Fa += 30) {
      const double P = EquivalentDynamicLoad(bearing, Fr, Fa);
      EXPECT_GT(EquivalentDynamicLoad(bearing, Fr + 30, Fa + 30), P);
      EXPECT_GE(EquivalentDynamicLoad(bearing, Fr, Fa + 30), P);
    }
  }
}

TEST(EquivalentDynamicLoad, ExceedsThePrintedCaseDistinctionByAtMost7PerMille) {
  const Bearing bearing = Ball(14000, 14);
  for (double Fa = 200; Fa < 6890; Fa += 10) {
    for (double ratio = 0.1; ratio < 1; ratio += 0.01) {
      const double Fr = Fa / ratio;
      const AxialFactors k = DeepGrooveFactors(Fa / 1000);
      const double printed = ratio <= k.e ? Fr : k.X * Fr + k.Y * Fa;
      const double P = EquivalentDynamicLoad(bearing, Fr, Fa);
      EXPECT_GE(P, printed * (1 - kRoundoff));
      EXPECT_LE(P, 1.007 * printed);
    }
  }
}

TEST(EquivalentStaticLoad, FollowsIso76) {
  const Bearing bearing = Ball(14000, 14);
  EXPECT_EQ(EquivalentStaticLoad(bearing, 1000, 500), 1000);
  EXPECT_EQ(EquivalentStaticLoad(bearing, 1000, 2000), 1600);
}

TEST(EquivalentLoads, OfARollerBearingAreItsRadialLoad) {
  Bearing bearing;
  bearing.kind = kRoller;
  EXPECT_EQ(EquivalentDynamicLoad(bearing, 123, 0), 123);
  EXPECT_EQ(EquivalentStaticLoad(bearing, 123, 0), 123);
}

TEST(MeanEffectiveLoad, OfSinusoidsIsTheClosedForm) {
  constexpr int kSteps = 3600;  // the third powers are trigonometric polynomials or smooth
  std::vector<double> rectified(kSteps), raised(kSteps);
  const std::vector<double> weights(kSteps, 1.0);
  for (int i = 0; i < kSteps; ++i) {
    const double phase = 2 * std::numbers::pi * i / kSteps;
    rectified[i] = std::abs(std::sin(phase));
    raised[i] = (1 - std::cos(phase)) / 2;
  }
  // mean |sin|^3 = 4 / (3 pi), mean ((1 - cos) / 2)^3 = 5 / 16.
  EXPECT_NEAR(MeanEffectiveLoad(rectified, weights, 3), std::cbrt(4 / (3 * std::numbers::pi)),
              1e-10);
  EXPECT_NEAR(MeanEffectiveLoad(raised, weights, 3), std::cbrt(5.0 / 16), kRoundoff);
}

TEST(MeanEffectiveLoad, OfALinearlyGrowingLoadIsNearTheCatalogueRule) {
  std::vector<double> loads;
  for (int i = 0; i < 1000; ++i) loads.push_back(1000 + 1.0 * (i + 0.5));
  const double mean = MeanEffectiveLoad(loads, std::vector<double>(1000, 1.0), 3);
  EXPECT_NEAR(mean, std::cbrt((std::pow(2.0, 4) - 1) / 4) * 1000, 1e-3);  // midpoint rule
  // The catalogues' (Fmin + 2 Fmax) / 3 is on the safe side, here by 7.3 %.
  EXPECT_NEAR((1000 + 2 * 2000) / 3.0 / mean, 1.073, 5e-4);
}

TEST(MeanEffectiveLoad, WeighsByRevolutions) {
  const std::vector<double> loads{1000, 2000}, weights{3, 1};
  EXPECT_NEAR(MeanEffectiveLoad(loads, weights, 3), std::cbrt((3e9 + 8e9) / 4), 1e-9);
  const double p = 10.0 / 3;
  EXPECT_NEAR(MeanEffectiveLoad(loads, weights, p),
              1000 * std::pow((3 + std::pow(2, p)) / 4, 1 / p), 1e-9);
  EXPECT_THROW(MeanEffectiveLoad(loads, std::vector<double>{1}, 3), std::invalid_argument);
}

TEST(ReliabilityFactor, IsTheTableOf2007AndLinearBetween) {
  EXPECT_EQ(ReliabilityFactor(90), 1);
  EXPECT_NEAR(ReliabilityFactor(95), 0.64, kRoundoff);
  EXPECT_NEAR(ReliabilityFactor(99), 0.25, kRoundoff);
  EXPECT_NEAR(ReliabilityFactor(99.95), 0.077, kRoundoff);
  EXPECT_NEAR(ReliabilityFactor(92.5), 0.82, kRoundoff);
}

TEST(ReliabilityFactor, RefusesWhatTheTableDoesNotCover) {
  EXPECT_THROW(ReliabilityFactor(89.9), std::invalid_argument);
  EXPECT_THROW(ReliabilityFactor(100), std::invalid_argument);
  EXPECT_THROW(ReliabilityFactor(std::nan("")), std::invalid_argument);
}

}  // namespace
}  // namespace vmech
