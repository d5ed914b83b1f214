#pragma once

#include "vmech/apps/html/markup.h"
#include "vmech/studies/study.h"

namespace vmech {

/// How a simulation went: why it ended, its energies over time, its events, its statistics.
html::Markup SimulationSection(const StudyFile& file, const SimulationResult& simulation);

}  // namespace vmech
