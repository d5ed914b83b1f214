#pragma once

#include "vmech/kinematics/tree/tree_workspace.h"

namespace vmech {

/// Six rows and a column for each velocity.
using Matrix6Xd = Eigen::Matrix<double, 6, Eigen::Dynamic>;

/// Poses of all nodes from coordinates q [nq], and the joints' twists; writes X and S. O(n), no
/// allocation, like all that follow.
template <typename T>
void ForwardKinematics(const KinematicTree& tree, const T* q, TreeWorkspace<T>* ws) noexcept;
/// Twists V of all nodes from velocities v [nv]. Needs S.
template <typename T>
void ForwardVelocities(const KinematicTree& tree, const T* v, TreeWorkspace<T>* ws) noexcept;
/// Needs V; writes c, and A for v' = 0.
template <typename T>
void VelocityProducts(const KinematicTree& tree, TreeWorkspace<T>* ws) noexcept;
/// Accelerations A of all nodes from v' [nv]. Needs S and c.
template <typename T>
void ForwardAccelerations(const KinematicTree& tree, const T* vdot, TreeWorkspace<T>* ws) noexcept;

/// q (+) dv in place: coordinates [nq] after moving by dv [nv] in the tangent space; quaternions
/// are brought back to unit length.
template <typename T>
void MoveCoordinates(const KinematicTree& tree, const T* dv, T* q);
/// The same for vectors dv [nv] and q [nq].
void MoveCoordinates(const KinematicTree& tree, const VectorXd& dv, VectorXd* q);

/// The rotation of a unit quaternion (w, x, y, z).
template <typename T>
Matrix3<T> RotationOf(const T* wxyz);

/// Pose in the world of a frame that is fixed in a node (node -1: the ground), from its pose X_BQ
/// there. Needs X.
Posed PoseInWorld(const TreeWorkspace<double>& ws, int node, const Posed& X_BQ);

/// Geometric Jacobian J of a frame Q that is fixed in a node, V_WQ = J v: its columns [nv] are
/// twists about Qo, [v; w], world axes. Needs X and S.
void GraspJacobian(const KinematicTree& tree, const TreeWorkspace<double>& ws, int node,
                   const Posed& X_BQ, Matrix6Xd* J);
/// The same with the frame Q in its node, and the columns, as kernels hold them.
void GraspJacobian(const KinematicTree& tree, const TreeWorkspace<double>& ws, int node,
                   const Frame& Q, std::vector<Screw>* J) noexcept;

/// Twist V_WQ [v; w] of a frame Q that is fixed in a node, about Qo, world axes. Needs V.
Vector6d GraspTwist(const TreeWorkspace<double>& ws, int node, const Posed& X_BQ);
/// Acceleration [a; alpha] of such a frame, of Qo and Q against the ground, world axes: what
/// SetGravity has given the ground is not in it. Needs V and A.
Vector6d GraspAcceleration(const TreeWorkspace<double>& ws, int node, const Posed& X_BQ);

// Small and everywhere: inline.

template <typename T>
Matrix3<T> RotationOf(const T* wxyz) {
  const T &w = wxyz[0], &x = wxyz[1], &y = wxyz[2], &z = wxyz[3];
  Matrix3<T> R;
  R << 1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y - w * z), 2.0 * (x * z + w * y),  //
      2.0 * (x * y + w * z), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z - w * x),   //
      2.0 * (x * z - w * y), 2.0 * (y * z + w * x), 1.0 - 2.0 * (x * x + y * y);
  return R;
}

}  // namespace vmech
