#pragma once

#include <filesystem>

#include "vmech/mechanisms/cad/cad_assembly.h"

namespace vmech {

struct StepReadOptions {
  /// Greatest distance of a mesh from the true surface [m], 0 or 1e-7..1. 0: no meshes. Smaller
  /// gives smoother and larger meshes; 1e-4 is good for a viewer.
  double mesh_deflection = 0;
  /// Read files with faulty entities, too. Parts may be missing then, or stand in wrong places.
  bool tolerate_faults = false;

  /// @throws std::invalid_argument
  void Validate() const;
};

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
