#include "vmech/base/lanes4.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace vmech {
namespace {

Lanes4 Lanes(double a, double b, double c, double d) {
  const double lanes[] = {a, b, c, d};
  return Lanes4::Of([&](int lane) { return lanes[lane]; });
}

TEST(Lanes4, SelectsLaneByLane) {
  const Lanes4 a = Lanes(1, -2, 3, -4), b = Lanes(0, 0, 5, 5);
  const Lanes4 larger = Select(a > b, a, b);
  EXPECT_EQ(larger[0], 1);
  EXPECT_EQ(larger[1], 0);
  EXPECT_EQ(larger[2], 5);
  EXPECT_EQ(larger[3], 5);
  EXPECT_FALSE(AllLanes(a > b));
  EXPECT_TRUE(AllLanes(abs(a) > Lanes4(0)));
}

TEST(Lanes4, NotANumberIsNeitherLessNorMore) {
  const Lanes4 nan = Lanes(0, std::nan(""), 0, 0);
  EXPECT_FALSE(AllLanes(nan <= Lanes4(1)));
  EXPECT_TRUE(std::isnan((nan + 1)[1]));
}

TEST(Lanes4, SineAndCosineAreThoseOfTheStandardLibrary) {
  constexpr double kRounding = 2.3e-16;  // one unit in the last place of 1
  for (double angle = -50; angle < 50; angle += 0.0137) {
    const Lanes4 angles = Lanes(angle, 7 * angle, 1000 * angle, 1e-9 * angle);
    Lanes4 sine, cosine;
    SinCos(angles, &sine, &cosine);
    for (int lane = 0; lane < Lanes4::kLanes; ++lane) {
      ASSERT_NEAR(sine[lane], std::sin(angles[lane]), kRounding) << angles[lane];
      ASSERT_NEAR(cosine[lane], std::cos(angles[lane]), kRounding) << angles[lane];
    }
  }
}

TEST(Lanes4, SineOfMultiplesOfAQuarterTurnAndOfHugeAngles) {
  constexpr double kRounding = 2.3e-16;
  for (int quarter = -9; quarter <= 9; ++quarter) {
    const double angle = quarter * std::numbers::pi / 2;
    Lanes4 sine, cosine;
    SinCos(Lanes(angle, 1e12 + quarter, 99999.5 + quarter, -angle), &sine, &cosine);
    ASSERT_NEAR(sine[0], std::sin(angle), kRounding);
    ASSERT_NEAR(cosine[0], std::cos(angle), kRounding);
    ASSERT_NEAR(sine[1], std::sin(1e12 + quarter), kRounding);
    ASSERT_NEAR(cosine[2], std::cos(99999.5 + quarter), kRounding);
    ASSERT_NEAR(sine[3], -std::sin(angle), kRounding);
  }
}

TEST(Lanes4, AngleIsThatOfTheStandardLibraryInEveryQuadrant) {
  constexpr double kRounding = 9e-16;  // two units in the last place of pi
  for (double angle = -std::numbers::pi; angle <= std::numbers::pi; angle += 0.00071) {
    const double x = 3 * std::cos(angle), y = 3 * std::sin(angle);
    const Lanes4 found = atan2(Lanes4(y), Lanes(x, 1e-8 * x, 1e8 * x, -x));
    ASSERT_NEAR(found[0], std::atan2(y, x), kRounding);
    ASSERT_NEAR(found[1], std::atan2(y, 1e-8 * x), kRounding);
    ASSERT_NEAR(found[2], std::atan2(y, 1e8 * x), kRounding);
    ASSERT_NEAR(found[3], std::atan2(y, -x), kRounding);
  }
}

TEST(Lanes4, AngleOfTheAxesAndTheOrigin) {
  const Lanes4 found = atan2(Lanes(0, 1, 0, -1), Lanes(0, 0, -1, 0));
  EXPECT_EQ(found[0], 0);
  EXPECT_EQ(found[1], std::numbers::pi / 2);
  EXPECT_EQ(found[2], std::numbers::pi);
  EXPECT_EQ(found[3], -std::numbers::pi / 2);
}

}  // namespace
}  // namespace vmech
