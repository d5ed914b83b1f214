#pragma once

#include "vmech/mechanisms/files/document.h"
#include "vmech/mechanisms/files/units.h"
#include "vmech/mechanisms/mechanism.h"
#include "vmech/studies/study.h"

namespace vmech {

/// An entry of a study's block `bearings`, whose key names a joint that turns about its z axis.
/// What is wrong is reported at the node.
BearingRequest ReadBearings(const Node& node, const Units& units, const Mechanism& mechanism);

}  // namespace vmech
