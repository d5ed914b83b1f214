#include "vmech/hw_interface/loop/histogram.h"

#include <gtest/gtest.h>

namespace vmech::histogram_test {
namespace {

TEST(Histogram, PercentilesAreRightWithinAnEighth) {
  Histogram h;
  for (int ns = 1; ns <= 100'000; ++ns) h.Add(ns);
  for (const double share : {0.001, 0.1, 0.5, 0.9, 0.99, 0.999}) {
    const double exact = share * 100'000;
    EXPECT_GE(static_cast<double>(h.Percentile(share)), exact);
    EXPECT_LE(static_cast<double>(h.Percentile(share)), exact * 1.125 + 1);
  }
}

TEST(Histogram, CountMeanAndMaximumAreExact) {
  Histogram h;
  for (const int ns : {0, 5, 7, 1'000'003}) h.Add(ns);
  EXPECT_EQ(h.count(), 4u);
  EXPECT_EQ(h.max(), 1'000'003);
  EXPECT_DOUBLE_EQ(h.mean(), 1'000'015 / 4.0);
  EXPECT_EQ(h.Percentile(1), 1'000'003);
  EXPECT_EQ(h.Percentile(0.5), 5);
}

TEST(Histogram, TakesAnyDuration) {
  Histogram h;
  EXPECT_EQ(h.Percentile(0.5), 0);
  h.Add(-5);
  h.Add(INT64_MAX);
  EXPECT_EQ(h.count(), 2u);
  EXPECT_EQ(h.max(), INT64_MAX);
}

}  // namespace
}  // namespace vmech::histogram_test
