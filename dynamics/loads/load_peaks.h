#pragma once

#include <vector>

#include "vmech/dynamics/loads/load_arrays.h"

namespace vmech {

/// The largest loads of a study.
struct LoadPeaks {
  /// Per joint: the largest size of every component [fx fy fz mx my mz].
  std::vector<Vector6d> components;
  double force = 0;  ///< of any joint, or of the hand [N]
};

/// Precondition: all loads are finite.
LoadPeaks FindPeaks(const LoadArrays& loads);

}  // namespace vmech
