#pragma once

#include <string>
#include <string_view>

#include "vmech/studies/sensitivities.h"

namespace vmech {

/// A page: a chart of the parameters that matter most for every figure, a table of all derivatives,
/// and what has none. The same input gives the same bytes.
std::string RenderSensitivityReport(const StudyFile& file, const Sensitivities& result,
                                    std::string_view version, std::string_view date);

}  // namespace vmech
