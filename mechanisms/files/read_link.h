#pragma once

#include "vmech/mechanisms/files/document.h"
#include "vmech/mechanisms/files/units.h"
#include "vmech/mechanisms/mechanism.h"

namespace vmech {

/// The parts of a file that describe one link. Each reports what is wrong at its node.

/// A frame from the keys `origin`, `z`, `x` and `y` of a map, or from `dh` in their place; other
/// keys are not looked at.
Posed ReadFrame(const Node& map, const Units& units);

/// The same on a link: relative to its frame, or to the anchor that the key `relative` names.
Posed ReadFrameOn(const Node& map, const Link& link, const Units& units);

/// An entry of `links`: mass, center_of_gravity, inertia or bodies, anchors.
Link ReadLink(const Node& node, const Units& units);

}  // namespace vmech
