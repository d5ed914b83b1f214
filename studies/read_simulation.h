#pragma once

#include <filesystem>
#include <string>

#include "vmech/mechanisms/files/document.h"
#include "vmech/mechanisms/files/units.h"
#include "vmech/studies/study.h"

namespace vmech {

/// Reads the block `simulation` of a study: its drives and times into `file->study`, everything
/// else into `file->simulation`. The mechanism has been read. What is wrong is reported at its
/// node.
void ReadSimulation(const Node& node, const Units& units, const std::filesystem::path& folder,
                    StudyFile* file);

/// A sound block `simulation` in words: "simulated for 2 s".
std::string SimulationInWords(const Node& node, const StudyFile& file);

}  // namespace vmech
