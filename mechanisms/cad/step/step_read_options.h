#pragma once

namespace vmech {

/// How a STEP file is read.
struct StepReadOptions {
  /// Greatest distance of a mesh from the true surface [m], 0 or 1e-7..1. 0: no meshes. Smaller
  /// gives smoother and larger meshes; 1e-4 is good for a viewer.
  double mesh_deflection = 0;
  /// Read files with faulty entities, too. Parts may be missing then, or stand in wrong places.
  bool tolerate_faults = false;

  /// @throws std::invalid_argument naming field, value and range.
  void Validate() const;
};

}  // namespace vmech
