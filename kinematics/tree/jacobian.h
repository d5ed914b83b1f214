#pragma once

#include "vmech/kinematics/tree/tree_workspace.h"

namespace vmech {

using Matrix6Xd = Eigen::Matrix<double, 6, Eigen::Dynamic>;

/// Geometric Jacobian J [6, nv] of a point Q that moves with a node, V_WQ = J v, [v; w], world
/// axes. Needs X_WB. `J` must be [6, nv].
void PointJacobian(const KinematicTree& tree, const TreeWorkspace<double>& ws, int node,
                   const Vector3d& p_WQ, Matrix6Xd* J);

/// Twist and acceleration [linear; angular] of a point Q of a node. Need w, v and alpha, a.
template <typename T>
Vector6<T> PointTwist(const TreeWorkspace<T>& ws, int node, const Vector3<T>& p_WQ);
Vector6d PointAcceleration(const TreeWorkspace<double>& ws, int node, const Vector3d& p_WQ);

}  // namespace vmech
