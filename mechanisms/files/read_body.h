#pragma once

#include "vmech/mechanisms/files/document.h"
#include "vmech/mechanisms/files/units.h"
#include "vmech/mechanisms/mass_properties.h"

namespace vmech {

/// A body of `bodies` in its own frame: a homogeneous box, cylinder, tube, cone or sphere, of a
/// density or of a mass. The frame is in its middle; that of a cone in the middle of its base, the
/// apex along z. Reports what is wrong at its node.
BodyNumbers<double> ReadBody(const Node& node, const Units& units);

}  // namespace vmech
