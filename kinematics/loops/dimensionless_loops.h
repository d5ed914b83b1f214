#pragma once

#include "vmech/kinematics/tree/kinematic_tree.h"

namespace vmech {

/// Characteristic lengths or radians per unit of each velocity [nv].
VectorXd VelocityScale(const KinematicTree& tree);

/// The scaled loop Jacobian at q: rows and columns of lengths measured in characteristic lengths.
MatrixXd DimensionlessLoopJacobian(const KinematicTree& tree, const VectorXd& q);

/// Pivots of the dimensionless C below this, or this times the largest, count as zero. Closed poses
/// are known to 1e-13; a real freedom leaves pivots of the order of 1.
inline constexpr double kRankTolerance = 1e-8;

}  // namespace vmech
