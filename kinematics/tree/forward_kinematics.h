#pragma once

#include "vmech/kinematics/tree/tree_workspace.h"

namespace vmech {

/// Poses of all nodes from coordinates q [nq]. Writes NodeState::X_WB. O(n), no allocation.
template <typename T>
void ForwardKinematics(const KinematicTree& tree, const T* q, TreeWorkspace<T>* ws);

/// Sine and cosine of the angles among q [nq], four at a time: in the order of
/// KinematicTree::turning, filled up to whole registers.
void Sines(const KinematicTree& tree, const double* q, double* sine, double* cosine) noexcept;

/// The rotation of a unit quaternion (w, x, y, z).
template <typename T>
Matrix3<T> RotationOf(const T* wxyz);

/// Velocities of all nodes from v [nv]. Needs X_WB; writes w, v.
template <typename T>
void ForwardVelocities(const KinematicTree& tree, const T* v, TreeWorkspace<T>* ws);

/// Accelerations of all nodes from v [nv] and vdot [nv]. Needs X_WB, w, v; writes alpha, a.
/// With vdot = nullptr it gives the accelerations that remain when v' is zero (J' q').
template <typename T>
void ForwardAccelerations(const KinematicTree& tree, const T* v, const T* vdot,
                          TreeWorkspace<T>* ws);

/// q (+) dv in place: coordinates [nq] after moving by dv [nv] in the tangent space; quaternions
/// are brought back to unit length.
template <typename T>
void MoveCoordinates(const KinematicTree& tree, const T* dv, T* q);
void MoveCoordinates(const KinematicTree& tree, const VectorXd& dv, VectorXd* q);

/// Pose of a frame that is fixed in a node (node -1: the ground), from its pose X_BQ there.
template <typename T>
Pose<T> PoseInWorld(const TreeWorkspace<T>& ws, int node, const Posed& X_BQ);

/// The unit twist [v; w] of a node's elementary joint, as felt at a point Q of the world that moves
/// with a descendant: V_Q = linear + angular x (Q - Bo).
template <typename T>
struct JointAxis {
  Vector3<T> angular;
  Vector3<T> linear;
};
/// `axis` is 0..2 for a spherical joint and 0 else. Needs X_WB.
template <typename T>
JointAxis<T> AxisInWorld(const KinematicTree& tree, const TreeWorkspace<T>& ws, int node_index,
                         int axis);

/// The same [v; w] at Q.
template <typename T>
Vector6<T> UnitTwistAt(const KinematicTree& tree, const TreeWorkspace<T>& ws, int node_index,
                       int axis, const Vector3<T>& p_WQ);

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

template <typename T>
Pose<T> PoseInWorld(const TreeWorkspace<T>& ws, int node, const Posed& X_BQ) {
  if (node < 0) return X_BQ.cast<T>();
  const Pose<T>& X_WB = ws.nodes[node].X_WB;
  return {X_WB.R * X_BQ.R, X_WB.R * X_BQ.p + X_WB.p};
}

template <typename T>
JointAxis<T> AxisInWorld(const KinematicTree& tree, const TreeWorkspace<T>& ws, int node_index,
                         int axis) {
  const TreeNode& node = tree.nodes[node_index];
  const Matrix3<T>& R_WB = ws.nodes[node_index].X_WB.R;
  const Vector3<T> zero = Vector3<T>::Zero();
  switch (node.motion) {
    case NodeMotion::kFixed:
      return {zero, zero};
    case NodeMotion::kRevolute:
      return {R_WB.col(2), zero};
    case NodeMotion::kPrismatic:
      return {zero, R_WB.col(2)};
    case NodeMotion::kScrew:
      return {R_WB.col(2), node.pitch * R_WB.col(2)};
    case NodeMotion::kSpherical:
      break;
  }
  if (!node.reversed) return {R_WB.col(axis), zero};
  const Vector3<T> column = node.X_PF.R.col(axis).cast<T>();
  if (node.parent < 0) return {-column, zero};
  return {-(ws.nodes[node.parent].X_WB.R * column), zero};
}

template <typename T>
Vector6<T> UnitTwistAt(const KinematicTree& tree, const TreeWorkspace<T>& ws, int node_index,
                       int axis, const Vector3<T>& p_WQ) {
  const Pose<T>& X_WB = ws.nodes[node_index].X_WB;
  const Vector3<T> r = p_WQ - X_WB.p;
  if (tree.nodes[node_index].motion == NodeMotion::kRevolute) {
    return Stacked<T>(X_WB.R.col(2).cross(r), X_WB.R.col(2));
  }
  const JointAxis<T> s = AxisInWorld(tree, ws, node_index, axis);
  return Stacked<T>(s.linear + s.angular.cross(r), s.angular);
}

}  // namespace vmech
