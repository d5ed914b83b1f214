#pragma once

#include <filesystem>

#include "vmech/mechanisms/cad/step/cad_assembly.h"
#include "vmech/mechanisms/cad/step/step_read_options.h"

namespace vmech {

/// Reads an assembly from a STEP file (AP203, AP214, AP242) through Open CASCADE's XDE: nested
/// assemblies, repeated components, names, placements, materials; any unit of length becomes
/// metres. Safe in several threads, one reads at a time. The file is read twice, first in a child
/// process, which damaged files may bring down.
/// @throws FileErrors if the file is not STEP, is cut off, damaged or empty, if a part is placed by
///         a mirror or a scale, or if vmech was built without Open CASCADE.
CadAssembly ReadStep(const std::filesystem::path& path, const StepReadOptions& options = {});

/// False if vmech was built without Open CASCADE.
bool HasStepReader();

}  // namespace vmech
