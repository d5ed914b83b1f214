#pragma once

#include <string>
#include <string_view>

#include "vmech/studies/design.h"

namespace vmech {

/// For a reader at the terminal: parameters and figures as they were and as they are, what binds,
/// and what would give more.
std::string PrintedDesign(const StudyFile& file, const DesignTask& task,
                          const DesignResult& result);

/// design.csv: kind (variable, objective, constraint), name, unit, before, after, lower, upper;
/// `gain` is by how much the objective improves for each unit by which a bound or limit is
/// loosened.
std::string DesignTable(const DesignTask& task, const DesignResult& result);

/// A page with the same, and every start. The same input gives the same bytes.
std::string RenderDesignReport(const StudyFile& file, const DesignTask& task,
                               const DesignResult& result, std::string_view version,
                               std::string_view date);

}  // namespace vmech
