#include "vmech/base/packet.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace vmech {
namespace {

Packet Lanes(double a, double b, double c, double d) {
  const double lanes[] = {a, b, c, d};
  return Packet::Of([&](int lane) { return lanes[lane]; });
}

TEST(Packet, SelectsLaneByLane) {
  const Packet a = Lanes(1, -2, 3, -4), b = Lanes(0, 0, 5, 5);
  const Packet larger = Select(a > b, a, b);
  EXPECT_EQ(larger[0], 1);
  EXPECT_EQ(larger[1], 0);
  EXPECT_EQ(larger[2], 5);
  EXPECT_EQ(larger[3], 5);
  EXPECT_FALSE(AllLanes(a > b));
  EXPECT_TRUE(AllLanes(abs(a) > Packet(0)));
}

TEST(Packet, NotANumberIsNeitherLessNorMore) {
  const Packet nan = Lanes(0, std::nan(""), 0, 0);
  EXPECT_FALSE(AllLanes(nan <= Packet(1)));
  EXPECT_TRUE(std::isnan((nan + 1)[1]));
}

TEST(Packet, SineAndCosineAreThoseOfTheStandardLibrary) {
  constexpr double kRounding = 2.3e-16;  // one unit in the last place of 1
  for (double angle = -50; angle < 50; angle += 0.0137) {
    const Packet angles = Lanes(angle, 7 * angle, 1000 * angle, 1e-9 * angle);
    Packet sine, cosine;
    SinCos(angles, &sine, &cosine);
    for (int lane = 0; lane < Packet::kLanes; ++lane) {
      ASSERT_NEAR(sine[lane], std::sin(angles[lane]), kRounding) << angles[lane];
      ASSERT_NEAR(cosine[lane], std::cos(angles[lane]), kRounding) << angles[lane];
    }
  }
}

TEST(Packet, SineOfMultiplesOfAQuarterTurnAndOfHugeAngles) {
  constexpr double kRounding = 2.3e-16;
  for (int quarter = -9; quarter <= 9; ++quarter) {
    const double angle = quarter * std::numbers::pi / 2;
    Packet sine, cosine;
    SinCos(Lanes(angle, 1e12 + quarter, 99999.5 + quarter, -angle), &sine, &cosine);
    ASSERT_NEAR(sine[0], std::sin(angle), kRounding);
    ASSERT_NEAR(cosine[0], std::cos(angle), kRounding);
    ASSERT_NEAR(sine[1], std::sin(1e12 + quarter), kRounding);
    ASSERT_NEAR(cosine[2], std::cos(99999.5 + quarter), kRounding);
    ASSERT_NEAR(sine[3], -std::sin(angle), kRounding);
  }
}

TEST(Packet, AngleIsThatOfTheStandardLibraryInEveryQuadrant) {
  constexpr double kRounding = 9e-16;  // two units in the last place of pi
  for (double angle = -std::numbers::pi; angle <= std::numbers::pi; angle += 0.00071) {
    const double x = 3 * std::cos(angle), y = 3 * std::sin(angle);
    const Packet found = atan2(Packet(y), Lanes(x, 1e-8 * x, 1e8 * x, -x));
    ASSERT_NEAR(found[0], std::atan2(y, x), kRounding);
    ASSERT_NEAR(found[1], std::atan2(y, 1e-8 * x), kRounding);
    ASSERT_NEAR(found[2], std::atan2(y, 1e8 * x), kRounding);
    ASSERT_NEAR(found[3], std::atan2(y, -x), kRounding);
  }
}

TEST(Packet, AngleOfTheAxesAndTheOrigin) {
  const Packet found = atan2(Lanes(0, 1, 0, -1), Lanes(0, 0, -1, 0));
  EXPECT_EQ(found[0], 0);
  EXPECT_EQ(found[1], std::numbers::pi / 2);
  EXPECT_EQ(found[2], std::numbers::pi);
  EXPECT_EQ(found[3], -std::numbers::pi / 2);
}

}  // namespace
}  // namespace vmech
