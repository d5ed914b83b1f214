#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "vmech/comparison/result.h"

namespace vmech {

/// summary.json: shares of success, branches and times per solver and block, for programs; the
/// keys are those of docs/compare.md.
std::string ComparisonSummary(const Suite& suite, const std::vector<Result>& results,
                              std::string_view version);

}  // namespace vmech
