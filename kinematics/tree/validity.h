#pragma once

#include <string_view>
#include <vector>

#include "vmech/kinematics/tree/kinematic_tree.h"

namespace vmech {

// What callers give along with a tree. `field` says what is looked at, as in "HandTracker: q".
// @throws std::invalid_argument naming field, value and what it must be.

/// Coordinates: [nq], finite.
void RequireCoordinates(std::string_view field, const KinematicTree& tree, const VectorXd& q);
/// Indices in v.
void RequireVelocities(std::string_view field, const KinematicTree& tree,
                       const std::vector<int>& indices);
/// Loops that are open by no more than `tolerance`, dimensionless as LargestLoopError.
void RequireClosed(std::string_view field, double error, double tolerance);
/// The index of a node; -1 is the ground.
void RequireNode(std::string_view field, const KinematicTree& tree, int node);

}  // namespace vmech
