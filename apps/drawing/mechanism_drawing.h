#pragma once

#include <string>

#include "vmech/kinematics/tree/kinematic_tree.h"

namespace vmech {

/// A mechanism at the start values of the tree as an SVG file of its own: links as bars in their
/// colours, joints by their symbols in the order of the mechanism (a dot of class `pivot` each),
/// the ground hatched, grasps, names, a scale bar, the axes of the world. Where a joint's anchors
/// do not meet, a dashed line spans the gap. The same tree gives the same bytes.
std::string DrawMechanism(const KinematicTree& tree);

}  // namespace vmech
