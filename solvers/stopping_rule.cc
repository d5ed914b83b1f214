#include "vmech/solvers/stopping_rule.h"

#include <fmt/format.h>

#include <limits>
#include <stdexcept>

namespace vmech {

void StoppingRule::Validate() const {
  constexpr double kTiny = std::numeric_limits<double>::min();
  CheckRange("StoppingRule", "constraint_tolerance", constraint_tolerance, kTiny, 1);
  CheckRange("StoppingRule", "optimality_tolerance", optimality_tolerance, kTiny, 1);
  CheckRange("StoppingRule", "max_iterations", max_iterations, 1, 1e9);
}

void CheckRange(std::string_view where, std::string_view name, double value, double low,
                double high) {
  if (value >= low && value <= high) return;
  throw std::invalid_argument(
      fmt::format("{}.{} = {}, must be in [{}, {}]", where, name, value, low, high));
}

}  // namespace vmech
