#pragma once

#include <filesystem>
#include <vector>

#include "vmech/mechanisms/files/document.h"
#include "vmech/mechanisms/files/units.h"
#include "vmech/studies/study.h"

namespace vmech {

/// Reads the block `paths` of a study whose motion was read: by grasp, where its origin is wanted
/// at every pose, in a list of points or in a table with the columns t, x, y, z.
std::vector<WantedPath> ReadPaths(const Node& node, const Units& units,
                                  const std::filesystem::path& folder, const LoadStudy& study);

}  // namespace vmech
