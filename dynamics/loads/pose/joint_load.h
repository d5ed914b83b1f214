#pragma once

#include <vector>

#include "vmech/base/pose.h"
#include "vmech/kinematics/tree/tree_workspace.h"

namespace vmech {

/// What a joint does and carries, in the axes of the anchor on its first link.
template <typename T>
struct JointLoad {
  Wrench<T> W_F;            ///< of the first link on the second, about the second anchor's origin
  Vector3<T> position;      ///< coordinates of its freedoms [m, rad]
  Vector3<T> rate;          ///< of the coordinates [m/s, rad/s]
  Vector3<T> acceleration;  ///< slopes of `rate` [m/s^2, rad/s^2]
};

/// Coordinates of the joints in the tree from q [nq]; of a spherical joint the rotation vector.
template <typename T>
void TreeJointPositions(const KinematicTree& tree, const T* q, std::vector<JointLoad<T>>* joints);
/// Rates of every joint, cut ones included, from v [nv]. Needs V.
template <typename T>
void JointRates(const KinematicTree& tree, const TreeWorkspace<T>& ws, const T* v,
                std::vector<JointLoad<T>>* joints);
/// The slopes of JointRates from v' [nv]. Needs V and A.
template <typename T>
void JointAccelerations(const KinematicTree& tree, const TreeWorkspace<T>& ws, const T* vdot,
                        std::vector<JointLoad<T>>* joints);

}  // namespace vmech
