#include "reference_cases.h"

#include <gtest/gtest.h>

#include <cctype>
#include <string>

#include "simulated.h"

namespace vmech {
namespace {

class ReferenceCaseTest : public testing::TestWithParam<ReferenceCase> {};

TEST_P(ReferenceCaseTest, IsMetToItsTolerance) {
  const ReferenceCase& c = GetParam();
  const SimulationResult result = Simulate(c.simulation, Tight(c.tolerance));
  ASSERT_EQ(result.status, SimulationStatus::kFinished) << result.message;
  for (const ReferenceValue& known : c.values) {
    EXPECT_NEAR(known.value(result, known.row), known.expected, known.allowed)
        << known.what << " at " << result.times[known.row];
  }
  EXPECT_LT(EnergyError(result), c.energy_error);
  EXPECT_LT(result.statistics.largest_closure, 1e-12);
  EXPECT_EQ(result.statistics.method, c.ends_by);
}

/// What a test's name may contain.
std::string WordOf(const std::string& name) {
  std::string word;
  for (const char c : name) {
    if (std::isalnum(static_cast<unsigned char>(c)) != 0) word += c;
  }
  return word;
}

INSTANTIATE_TEST_SUITE_P(All, ReferenceCaseTest, testing::ValuesIn(ReferenceCases()),
                         [](const auto& info) { return WordOf(info.param.name); });

}  // namespace
}  // namespace vmech
