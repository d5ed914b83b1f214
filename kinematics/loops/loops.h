#pragma once

#include "vmech/kinematics/tree/tree_workspace.h"

namespace vmech {

/// Loop closure, paper eq. (4)-(6), for a cut joint of any type. F and M are the anchors of the cut
/// joint on its first and second link. With f freedoms the joint closes its loop with 6 - f
/// equations, the directions in which M may not move in F:
///
///   revolute, cylindrical  p_x p_y (p_z)  r_x r_y          prismatic  p_x p_y  r_x r_y r_z
///   screw      p_x p_y  r_x r_y  p_z - pitch r_z            planar     p_z  r_x r_y
///   universal  p_x p_y p_z  and the rotation about y_M x x_F
///   spherical  p_x p_y p_z                                  weld       all six
///
/// all in axes of F. r is the rotation that is left, 2 sin(angle/2) times its axis; where the joint
/// turns about z, it is the turn that brings z_M back onto z_F. Unlike the paper's sine (eq. 6) it
/// grows up to half a turn, so that a loop assembled upside down does not pass for closed.

/// Needs X; writes everything in LoopState but `bias` and `wrench`.
template <typename T>
void LoopErrors(const KinematicTree& tree, TreeWorkspace<T>* ws);

/// The same of one loop, from where M is in F; writes R_FM, p_FM, n_F and e2.
template <typename T>
void LoopError(const Loop& loop, const Matrix3<T>& R_FM, const Vector3<T>& p_FM,
               LoopState<T>* state);

/// The rows of C as wrenches, LoopState::wrench: C_kv = +-wrench[k] . S_v for the velocities around
/// the loop, and a multiplier mu_k puts mu_k wrench[k] on the second link. `row_scale` [tree.rows]
/// multiplies them; null: as they are. Needs LoopErrors.
template <typename T>
void LoopWrenches(const KinematicTree& tree, const double* row_scale, TreeWorkspace<T>* ws);

/// The same of one loop; its rotations are those about x, y, z of `turns`.
template <typename T>
void FindLoopWrenches(const Loop& loop, const FrameT<T>& turns, LoopState<T>* state);

/// C = -d e2 / dv at a closed loop (paper eq. 4: e2 = C dq). Needs LoopErrors and S; writes
/// LoopState::wrench and loop_columns.
template <typename T>
void LoopJacobian(const KinematicTree& tree, TreeWorkspace<T>* ws);

/// s dC/dt v of one loop, in the scale of its wrenches: s times the part of the relative
/// acceleration of the anchors that is there when v' = 0. Needs LoopWrenches, V and A of
/// VelocityProducts; writes Loop::rows entries.
template <typename T>
void LoopBias(const KinematicTree& tree, const TreeWorkspace<T>& ws, int loop, double s, T* bias);
/// The same of all loops, s = 1, into LoopState::bias: a closed loop obeys C v' + bias = 0.
template <typename T>
void LoopAccelerationBias(const KinematicTree& tree, TreeWorkspace<T>* ws);

/// T' [v; w]: the equations' share of a twist of M in F, in axes of F. What is behind the last of
/// the loop's rows is zero.
template <typename T>
Vector6<T> ProjectOnRows(const Loop& loop, const LoopState<T>& state, const Vector3<T>& linear,
                         const Vector3<T>& angular);

/// T mu: the wrench on the second link about M, in axes of F, of multipliers mu [rows] on the
/// equations.
Wrenchd WrenchOfMultipliers(const Loop& loop, const LoopState<double>& state, const double* mu);
/// The same about the reference point, by LoopState::wrench.
template <typename T>
ScrewT<T> LoopWrench(const Loop& loop, const LoopState<T>& state, const T* mu);

/// True if equation `row` of a loop that a joint of this type closes is one of lengths [m].
inline bool IsLengthRow(JointType type, int row);

/// Largest loop error, lengths divided by the characteristic length. A loop assembled half a turn
/// the wrong way counts with its full error. Needs LoopErrors.
template <typename T>
T LargestLoopError(const KinematicTree& tree, const TreeWorkspace<T>& ws);

/// How fast loops open with a parameter: the largest slope of their errors, scaled as
/// LargestLoopError, and the loop that has it (-1 without loops). For T = Dual. Needs LoopErrors.
struct LoopOpening {
  double slope = 0;  ///< of the error, per unit of the parameter
  int loop = -1;     ///< index in KinematicTree::loops
};
/// The largest over all loops of the tree, at the pose that ws is of.
template <typename T>
LoopOpening LargestOpening(const KinematicTree& tree, const TreeWorkspace<T>& ws);

/// Dense C [rows, nv] for the analyses that need it whole. Needs LoopJacobian.
MatrixXd DenseLoopJacobian(const KinematicTree& tree, const TreeWorkspace<double>& ws);
/// All e2, stacked [rows]; lengths in metres, rotations in radians.
VectorXd StackedLoopErrors(const KinematicTree& tree, const TreeWorkspace<double>& ws);
/// 1/length for rows that are lengths, 1 for rotations [rows]: makes C dimensionless.
VectorXd LoopRowScale(const KinematicTree& tree);

// Small and everywhere: inline.

bool IsLengthRow(JointType type, int row) {
  switch (type) {
    case JointType::kPrismatic:
    case JointType::kCylindrical:
      return row < 2;
    case JointType::kScrew:
      return row < 2 || row == 4;
    case JointType::kPlanar:
      return row < 1;
    default:
      return row < 3;
  }
}

template <typename T>
Vector6<T> ProjectOnRows(const Loop& loop, const LoopState<T>& state, const Vector3<T>& linear,
                         const Vector3<T>& angular) {
  const T zero(0);
  const Vector3<T>&l = linear, &a = angular;
  switch (loop.type) {
    case JointType::kRevolute:
      return {l[0], l[1], l[2], a[0], a[1], zero};
    case JointType::kPrismatic:
      return {l[0], l[1], a[0], a[1], a[2], zero};
    case JointType::kCylindrical:
      return {l[0], l[1], a[0], a[1], zero, zero};
    case JointType::kScrew:
      return {l[0], l[1], a[0], a[1], l[2] - state.pitch * a[2], zero};
    case JointType::kUniversal:
      return {l[0], l[1], l[2], state.n_F.dot(a), zero, zero};
    case JointType::kSpherical:
      return {l[0], l[1], l[2], zero, zero, zero};
    case JointType::kPlanar:
      return {l[2], a[0], a[1], zero, zero, zero};
    case JointType::kWeld:
      break;
  }
  return Stacked<T>(l, a);
}

}  // namespace vmech
