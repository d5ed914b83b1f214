#pragma once

#include <vector>

#include "vmech/kinematics/tree/tree_workspace.h"

namespace vmech {

/// A joint in one pose. F is the anchor on its first link, M that on its second.
template <typename T>
struct JointState {
  FrameT<T> F;       ///< axes of F at the origin of M
  Triple<T> across;  ///< kUniversal: unit vector across both axes, the one moment it holds
  ScrewT<T> W;       ///< what the first link exerts on the second
};

/// Frames of all joints. Needs X; writes F and across.
template <typename T>
void JointFrames(const KinematicTree& tree, const TreeWorkspace<T>& ws,
                 std::vector<JointState<T>>* joints) noexcept;
/// Wrenches of the tree joints from F of the nodes; those of cut joints are left alone.
template <typename T>
void TreeJointWrenches(const KinematicTree& tree, const TreeWorkspace<T>& ws,
                       std::vector<JointState<T>>* joints) noexcept;

/// A wrench from outside on a node: what is less to be exerted on it and all that carry it.
template <typename T>
void ApplyAlongBranch(const KinematicTree& tree, int node, const ScrewT<T>& W,
                      TreeWorkspace<T>* ws) noexcept;
/// What the first link of a cut joint exerts on the second, all around the loop.
template <typename T>
void ApplyAroundLoop(const Loop& loop, const ScrewT<T>& W, TreeWorkspace<T>* ws) noexcept;
/// The same of the multipliers mu [rows] of all cut joints, and their share of the joints'
/// wrenches: W of the cut joints becomes that. Needs LoopState::wrench.
template <typename T>
void ApplyMultipliers(const KinematicTree& tree, const T* mu, TreeWorkspace<T>* ws,
                      std::vector<JointState<T>>* joints) noexcept;

}  // namespace vmech
