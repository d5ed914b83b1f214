#pragma once

#include "vmech/base/eigen.h"

namespace vmech {

/// A direction of any length, times the power of two that brings its greatest entry to between 1
/// and 2: nothing of it is rounded, and no square of it is lost. Zero and what is not finite stay.
Vector3d NearUnitLength(const Vector3d& direction);

}  // namespace vmech
