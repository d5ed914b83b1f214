#pragma once

#include <vector>

#include "vmech/base/pose.h"
#include "vmech/kinematics/tree/kinematic_tree.h"

namespace vmech {

/// The drawing frames of all links in the world at the start values of the tree.
std::vector<Posed> LinkPoses(const KinematicTree& tree);

/// From where a mechanism is seen: unit vectors in the world.
struct View {
  Vector3d right, up, toward;  ///< of the drawing, and from it to the eye
  bool planar = false;         ///< along the axis that all rotations share
};

/// Along the common axis of a planar mechanism: all axes of rotation are parallel, all slides are
/// across them. Else along the space diagonal (isometric). What is up in the drawing is up under
/// the mechanism's gravity, or z where there is none, as far as that can be seen.
View ViewOf(const Mechanism& mechanism, const std::vector<Posed>& X_WL);

}  // namespace vmech
