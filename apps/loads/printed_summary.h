#pragma once

#include <filesystem>
#include <map>

#include "vmech/studies/study.h"

namespace vmech {

/// What `vmech loads` and `vmech simulate` say on the terminal, with where the report is.
void PrintSummary(const StudyFile& file, const StudyOutcome& outcome,
                  const std::filesystem::path& folder);

/// How often each kind of event happened.
std::map<SimulationEvent::Kind, int> CountEvents(const SimulationResult& simulation);

}  // namespace vmech
