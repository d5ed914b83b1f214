#pragma once

#include <vector>

#include "vmech/base/linear_algebra/block_null_space.h"
#include "vmech/kinematics/tree/kinematic_tree.h"
#include "vmech/kinematics/tree/tree_workspace.h"

namespace vmech {

/// What counts as one of each velocity in dimensionless equations [nv]: the characteristic length
/// [m] for a translation, 1 rad for a rotation.
VectorXd VelocityScale(const KinematicTree& tree);

/// The scaled loop Jacobian at q: rows and columns of lengths measured in characteristic lengths.
MatrixXd DimensionlessLoopJacobian(const KinematicTree& tree, const VectorXd& q);

/// LoopRowScale, with zeros for the loops that are closed wherever the tree goes, as by the second
/// hinge of a door or a second guide beside a first: there is but rounding in their rows, which no
/// solver that judges rows by their own size must take for equations. Looks at the start and at a
/// pose far from it.
VectorXd BindingRowScale(const KinematicTree& tree);

/// The rows of one loop in DimensionlessLoopJacobian, by their columns. Needs LoopJacobian in ws.
RowBlock DimensionlessLoopRows(const KinematicTree& tree, const TreeWorkspace<double>& ws,
                               size_t loop);

/// The dimensionless motions of a closed pose, those of the `held` velocities [nv] left out: the
/// null space of its C, loop by loop, with kRankTolerance.
BlockNullSpace LoopNullSpace(const KinematicTree& tree, const VectorXd& q,
                             const std::vector<bool>& held = {});

/// Pivots of the dimensionless C below this, or this times the largest, count as zero. Closed poses
/// are known to 1e-13; a real freedom leaves pivots of the order of 1.
inline constexpr double kRankTolerance = 1e-8;

}  // namespace vmech
