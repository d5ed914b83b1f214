#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "vmech/comparison/result.h"

namespace vmech {

/// The report of `vmech compare` as one self-contained HTML page: who solved how much, performance
/// profiles, accuracy, times, every failure with its reason, and how all this was found. `results`
/// are sorted as RunComparison gives them. The same results give the same bytes.
std::string RenderComparisonReport(const Suite& suite, const std::vector<Result>& results,
                                   std::string_view version);

}  // namespace vmech
