#include "vmech/apps/plot/scale.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace vmech::plot {
namespace {

std::vector<std::string> Labels(const Scale& scale) {
  std::vector<std::string> labels;
  for (const Tick& tick : scale.ticks) labels.push_back(tick.label);
  return labels;
}
using Strings = std::vector<std::string>;

TEST(Scale, TicksStandAtOneTwoOrFiveTimesAPowerOfTen) {
  EXPECT_EQ(Labels(MakeScale(ScaleType::kLinear, -330, 1080, 4, true)),
            (Strings{"−500", "0", "500", "1000", "1500"}));
  EXPECT_EQ(Labels(MakeScale(ScaleType::kLinear, 0, 0.9, 5, true)),
            (Strings{"0.0", "0.2", "0.4", "0.6", "0.8", "1.0"}));
}

TEST(Scale, RoundedRangeCoversTheDataAndEndsOnTicks) {
  for (const double max : {0.011, 0.7, 3.0, 42.0, 99999.0}) {
    const Scale scale = MakeScale(ScaleType::kLinear, -max / 3, max, 4, true);
    EXPECT_LE(scale.lower, -max / 3);
    EXPECT_GE(scale.upper, max);
    EXPECT_EQ(scale.lower, scale.ticks.front().value);
    EXPECT_EQ(scale.upper, scale.ticks.back().value);
  }
}

TEST(Scale, AnglesAreDividedAtRightAngles) {
  EXPECT_EQ(Labels(MakeScale(ScaleType::kDegrees, 0, 360, 5, false)),
            (Strings{"0", "90", "180", "270", "360"}));
  EXPECT_EQ(Labels(MakeScale(ScaleType::kDegrees, 0, 720, 5, false)),
            (Strings{"0", "180", "360", "540", "720"}));
}

TEST(Scale, RangeReachesToATickThatIsNear) {
  EXPECT_EQ(MakeScale(ScaleType::kDegrees, 0, 719, 5, false).upper, 720);
  EXPECT_EQ(MakeScale(ScaleType::kDegrees, 0, 700, 5, false).upper, 700);
}

TEST(Scale, SmallValuesBringAPowerOfTenIntoTheUnit) {
  const Scale scale = MakeScale(ScaleType::kLinear, 0, 3.1e-10, 4, true);
  EXPECT_EQ(scale.exponent, -12);
  EXPECT_EQ(scale.ticks.back().label, "400");
  EXPECT_EQ(ScaledUnit("W", scale.exponent), "pW");
  EXPECT_EQ(ScaledUnit("mm", -6), "10⁻⁶ mm");
  EXPECT_EQ(ScaledUnit("N m", 3), "kN m");
}

TEST(Scale, LogarithmicTicksAreDecades) {
  const Scale scale = MakeScale(ScaleType::kLog, 2e-6, 3e-2, 4, true);
  EXPECT_EQ(Labels(scale), (Strings{"10⁻⁶", "10⁻⁵", "10⁻⁴", "10⁻³", "10⁻²", "10⁻¹"}));
  EXPECT_NEAR(scale.Fraction(1e-4), 0.4, 1e-12);
  EXPECT_TRUE(std::isnan(scale.Fraction(0)));
}

TEST(Scale, RangesThatCannotBeDrawnAreReplaced) {
  const double infinity = std::numeric_limits<double>::infinity();
  for (const ScaleType type : {ScaleType::kLinear, ScaleType::kDegrees, ScaleType::kLog}) {
    for (const auto& [min, max] : {std::pair(infinity, -infinity),
                                   {0.0, 0.0},
                                   {5.0, 5.0},
                                   {-3.0, -3.0},
                                   {std::nan(""), 1.0}}) {
      const Scale scale = MakeScale(type, min, max, 4, true);
      EXPECT_LT(scale.lower, scale.upper);
      EXPECT_FALSE(scale.ticks.empty());
      EXPECT_LT(scale.ticks.size(), 20u);
    }
  }
}

TEST(Scale, RoundingNoiseOnAConstantIsNotMagnified) {
  const Scale scale = MakeScale(ScaleType::kLinear, 100, std::nextafter(100, 200), 4, true);
  EXPECT_EQ(scale.lower, 0);
}

TEST(MakeScale, LabelsTurnsWithinTheTurn) {
  const Scale scale = MakeScale(ScaleType::kTurns, 0, 720, 5, false);
  Strings labels;
  for (const Tick& tick : scale.ticks) labels.push_back(tick.label);
  EXPECT_EQ(labels, (Strings{"0", "180", "360", "180", "360"}));
}

TEST(FormatNumber, GroupsThousandsFromFiveDigitsOn) {
  EXPECT_EQ(FormatNumber(1234.56, 1), "1234.6");
  EXPECT_EQ(FormatNumber(-1234567, 0), "−1\u202F234\u202F567");
  EXPECT_EQ(FormatNumber(-0.0004, 2), "0.00");
}

TEST(FormatSignificant, KeepsTheDigitsThatCount) {
  EXPECT_EQ(FormatSignificant(0.0123456, 3), "0.0123");
  EXPECT_EQ(FormatSignificant(98765.4, 3), "98\u202F765");
  EXPECT_EQ(FormatSignificant(-1.24e-9, 2), "−1.2×10⁻⁹");
  EXPECT_EQ(FormatSignificant(9.996, 3), "10.0");
  EXPECT_EQ(FormatSignificant(std::nan(""), 3), "–");
}

TEST(FormatShort, LeavesOutZerosThatSayNothing) {
  EXPECT_EQ(FormatShort(15, 3), "15");
  EXPECT_EQ(FormatShort(0.4, 3), "0.4");
  EXPECT_EQ(FormatShort(1500, 4), "1500");
  EXPECT_EQ(FormatShort(-2e-12, 2), "−2×10⁻¹²");
  EXPECT_EQ(FormatShort(12.25, 4), "12.25");
}

}  // namespace
}  // namespace vmech::plot
