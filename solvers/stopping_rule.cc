#include "vmech/solvers/stopping_rule.h"

#include "vmech/base/check_range.h"

#include <limits>

namespace vmech {

void StoppingRule::Validate() const {
  constexpr double kTiny = std::numeric_limits<double>::min();
  CheckRange("StoppingRule", "constraint_tolerance", constraint_tolerance, kTiny, 1);
  CheckRange("StoppingRule", "optimality_tolerance", optimality_tolerance, kTiny, 1);
  CheckRange("StoppingRule", "max_iterations", max_iterations, 1, 1e9);
}

}  // namespace vmech
