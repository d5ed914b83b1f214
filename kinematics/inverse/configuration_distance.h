#pragma once

#include "vmech/kinematics/tree/kinematic_tree.h"

namespace vmech {

/// The displacement [nv; rad, m] that leads from configuration a to b [nq], each joint by the
/// shorter way round: MoveCoordinates takes a there. No allocation.
void CoordinateDifference(const KinematicTree& tree, const VectorXd& a, const VectorXd& b,
                          VectorXd* difference) noexcept;
/// The same displacement in radians and characteristic lengths [nv].
VectorXd ConfigurationDifference(const KinematicTree& tree, const VectorXd& a, const VectorXd& b);

/// How far two configurations are apart: the norm of the differences of all coordinates of the
/// tree, in radians (whole turns do not count) and characteristic lengths.
double ConfigurationDistance(const KinematicTree& tree, const VectorXd& a, const VectorXd& b);

}  // namespace vmech
