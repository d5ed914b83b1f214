#include "vmech/dynamics/loads/load_result.h"

#include <fmt/format.h>

namespace vmech {

std::string LoadStudyResult::BriefReport() const {
  const auto plural = [](size_t count) { return count == 1 ? "" : "s"; };
  return fmt::format(
      "{} pose{}, mobility {}, {} redundant equation{}, closure {:.1e}, power {:.1e}", poses.size(),
      plural(poses.size()), mobility, redundant_equations, plural(redundant_equations), max_closure,
      max_power_error);
}

}  // namespace vmech
