#pragma once

#include <cmath>
#include <numbers>
#include <vector>

#include "vmech/kinematics/tree/tree_workspace.h"

namespace vmech {

// What a cut joint does: its coordinates, and how fast they change. F and M are its anchors on its
// first and second link. LoopErrors has been called.

/// Coordinates of a cut joint that has turned and shifted freely, from the poses of its anchors
/// [FreedomsOf(type)]; for a spherical joint the rotation vector. Angles within +-pi.
template <typename T>
Vector3<T> CutJointCoordinates(const Loop& loop, const LoopState<T>& state);

/// Unit twists [v; w] of M in F of the freedoms of a cut joint, axes of F.
template <typename T>
struct CutJointFreedoms {
  int count = 0;          ///< 0 to 3
  Vector6<T> twist_F[3];  ///< the first `count` of them
};
/// The freedoms of the joint at which a loop is cut, at the pose that `state` is of.
template <typename T>
CutJointFreedoms<T> FreedomsOfCutJoint(const Loop& loop, const LoopState<T>& state);

/// Rates of the coordinates of a cut joint [FreedomsOf(type)]; for a spherical joint the angular
/// velocity of M in F, axes of M. Needs V.
template <typename T>
Vector3<T> CutJointRates(const KinematicTree& tree, const TreeWorkspace<T>& ws, int loop);

/// The slopes of CutJointRates [FreedomsOf(type)]. With V_FM the twist of M in F and V_FM' its
/// rate, both as an observer on F sees them, and t_i the unit twists of the freedoms,
///
///   q_i'' = t_i . V_FM' / |t_i|^2,
///
/// since t_i' . V_FM = 0: of the t_i only axes turn that are fixed on M, and those turn across
/// V_FM. Needs V and A.
template <typename T>
Vector3<T> CutJointAccelerations(const KinematicTree& tree, const TreeWorkspace<T>& ws, int loop);

/// Coordinates of the cut joints as the mechanism states its start [loops].
std::vector<Vector3d> StartCutPositions(const KinematicTree& tree);

/// Goes on from `position`, the coordinates of a cut joint a moment ago, to those `now`: of an
/// angle only the part within a turn is seen, and the turns are those that make the step short.
void ContinueCutPosition(JointType type, const Vector3d& now, Vector3d* position);

/// The same for the cut joints of all loops [loops], at the pose that `ws` is of.
void ContinueCutPositions(const KinematicTree& tree, const TreeWorkspace<double>& ws,
                          std::vector<Vector3d>* positions);

/// The angle by which M is turned about z of F, within +-pi.
template <typename T>
T TurnAboutZ(const Matrix3<T>& R_FM) {
  using std::atan2;
  return atan2(R_FM(1, 0) - R_FM(0, 1), R_FM(0, 0) + R_FM(1, 1));
}

/// The turn of a screw joint; whole turns are told by the travel.
template <typename T>
T ScrewTurn(const Matrix3<T>& R_FM, const T& travel, const T& pitch) {
  using std::round;
  constexpr double kTurn = 2 * std::numbers::pi;
  const T angle = TurnAboutZ(R_FM);
  return angle + kTurn * round((travel / pitch - angle) / kTurn);
}

}  // namespace vmech
