#pragma once

#include "vmech/kinematics/tree/kinematic_tree.h"

namespace vmech {

/// From one configuration to another: the way [nv; rad, m] that leads from a to b, each joint by
/// the shorter way round; MoveCoordinates goes it. No allocation.
void CoordinateDifference(const KinematicTree& tree, const VectorXd& a, const VectorXd& b,
                          VectorXd* difference) noexcept;
/// The same in radians and characteristic lengths.
VectorXd ConfigurationDifference(const KinematicTree& tree, const VectorXd& a, const VectorXd& b);

/// How far two configurations are apart: the norm of the differences of all coordinates of the
/// tree, in radians (whole turns do not count) and characteristic lengths.
double ConfigurationDistance(const KinematicTree& tree, const VectorXd& a, const VectorXd& b);

/// Characteristic lengths or radians to the units of each velocity [nv].
VectorXd TangentScale(const KinematicTree& tree);

}  // namespace vmech
