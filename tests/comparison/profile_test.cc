#include "vmech/comparison/profile.h"

#include <gtest/gtest.h>

#include <limits>
#include <stdexcept>

namespace vmech {
namespace {

constexpr double kNever = std::numeric_limits<double>::infinity();

// Three solvers on four problems, worked out by hand. Ratios to the best of each problem:
//   1 2 4      A is best
//   2 1 1      B and C share the first place
//   1 - 3      B fails
//   - - -      nobody solves it
const std::vector<std::vector<double>> kCosts = {
    {1, 2, 4}, {6, 3, 3}, {5, kNever, 15}, {kNever, kNever, kNever}};

TEST(PerformanceProfile, AgreesWithACaseWorkedOutByHand) {
  const PerformanceProfile profile = MakePerformanceProfile(kCosts);
  ASSERT_EQ(profile.curves.size(), 3u);
  const auto &a = profile.curves[0], &b = profile.curves[1], &c = profile.curves[2];
  EXPECT_EQ(a.ratio, (std::vector<double>{1, 2}));
  EXPECT_EQ(a.share, (std::vector<double>{0.5, 0.75}));
  EXPECT_EQ(b.ratio, (std::vector<double>{1, 2}));
  EXPECT_EQ(b.share, (std::vector<double>{0.25, 0.5}));
  EXPECT_EQ(c.ratio, (std::vector<double>{1, 3, 4}));
  EXPECT_EQ(c.share, (std::vector<double>{0.25, 0.5, 0.75}));
  EXPECT_EQ(profile.largest_ratio, 4);
}

TEST(PerformanceProfile, IsAStepFunctionClosedFromTheLeft) {
  const PerformanceProfile::Curve c = MakePerformanceProfile(kCosts).curves[2];
  EXPECT_EQ(c.At(0.999), 0);
  EXPECT_EQ(c.At(1), 0.25);
  EXPECT_EQ(c.At(2.999), 0.25);
  EXPECT_EQ(c.At(3), 0.5);
  EXPECT_EQ(c.At(1e9), 0.75);
}

TEST(PerformanceProfile, DoesNotDependOnTheUnitOfTheCosts) {
  std::vector<std::vector<double>> scaled = kCosts;
  for (std::vector<double>& problem : scaled) {
    for (double& cost : problem) cost *= 1024;  // exact
  }
  EXPECT_EQ(MakePerformanceProfile(scaled).curves[2].ratio,
            MakePerformanceProfile(kCosts).curves[2].ratio);
}

TEST(PerformanceProfile, RefusesCostsThatHaveNoRatio) {
  EXPECT_THROW(MakePerformanceProfile({{1, 2}, {0, 1}}), std::invalid_argument);
  EXPECT_THROW(MakePerformanceProfile({{1, 2}, {1}}), std::invalid_argument);
}

TEST(CumulativeShare, CountsWhatIsNeverReached) {
  const auto share = CumulativeShare({2, 1, kNever, 2});
  EXPECT_EQ(share.ratio, (std::vector<double>{1, 2}));
  EXPECT_EQ(share.share, (std::vector<double>{0.25, 0.75}));
}

}  // namespace
}  // namespace vmech
