#pragma once

#include <vector>

#include "vmech/mechanisms/files/document.h"
#include "vmech/mechanisms/files/units.h"
#include "vmech/mechanisms/mechanism.h"

namespace vmech {

/// The parts of a file that are written by Denavit-Hartenberg parameters (dh_parameters.h).

/// The pose that rows lead to, one after the other: a map {theta, d, a, alpha, beta}, where what is
/// not given is zero, or a list of such maps.
Posed ReadDhRows(const Node& node, const Units& units);

/// A joint with the key `dh` connects links by name, as a row of a table does: it lies on the z
/// axis of its first link's frame, and its row leads from there to the frame of the second link.
/// Gives both links an anchor of the joint's name. What is wrong with the names is ReadJoint's.
void AddDhAnchors(const Node& joints, const Units& units, std::vector<Link>* links);

}  // namespace vmech
