#pragma once

#include "vmech/mechanisms/mechanism.h"

namespace vmech {

/// Takes the roundoff of the CAD file (12 digits) and of our own products out of a mechanism, so
/// that what was drawn at 150 mm along x stands so in the file: lengths to a picometre, axes along
/// those of the link exactly, inertias below 1e-12 of the largest zero, starts to 1e-9 degrees.
void Tidy(Mechanism* mechanism);

}  // namespace vmech
