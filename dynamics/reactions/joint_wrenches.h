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
/// Writes W of the joints in the tree from F of the nodes; that of cut joints is left alone.
template <typename T>
void TreeJointWrenches(const KinematicTree& tree, const TreeWorkspace<T>& ws,
                       std::vector<JointState<T>>* joints) noexcept;

/// Applies a wrench from outside to a node: its parent, and all that carry it, have so much less to
/// exert.
template <typename T>
void ApplyAlongBranch(const KinematicTree& tree, int node, const ScrewT<T>& W,
                      TreeWorkspace<T>* ws) noexcept;
/// Applies what the first link of a cut joint exerts on the second to all nodes around the loop.
template <typename T>
void ApplyAroundLoop(const Loop& loop, const ScrewT<T>& W, TreeWorkspace<T>* ws) noexcept;
/// The same of the multipliers mu [rows] of all cut joints, and their share of the joints'
/// wrenches: W of the cut joints becomes that. Needs LoopState::wrench.
template <typename T>
void ApplyMultipliers(const KinematicTree& tree, const T* mu, TreeWorkspace<T>* ws,
                      std::vector<JointState<T>>* joints) noexcept;

}  // namespace vmech
