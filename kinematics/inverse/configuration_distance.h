#pragma once

#include "vmech/kinematics/tree/kinematic_tree.h"

namespace vmech {

/// From one configuration to another: a velocity [nv, radians and characteristic lengths] that
/// leads from a to b in a unit of time, each joint by the shorter way round.
VectorXd ConfigurationDifference(const KinematicTree& tree, const VectorXd& a, const VectorXd& b);

/// How far two configurations are apart: the norm of the differences of all coordinates of the
/// tree, in radians (whole turns do not count) and characteristic lengths.
double ConfigurationDistance(const KinematicTree& tree, const VectorXd& a, const VectorXd& b);

/// Characteristic lengths or radians to the units of each velocity [nv].
VectorXd TangentScale(const KinematicTree& tree);

}  // namespace vmech
