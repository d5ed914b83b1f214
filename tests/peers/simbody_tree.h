#pragma once

#include <vector>

#include "simbody_model.h"

namespace vmech::peers {

/// A joint of the tree, passed from parent to child; links by index.
struct TreeJoint {
  int joint;
  int parent;
  int child;
};

/// A spanning tree from ground outwards, parents before children. Driven joints and screws are in
/// it; then joints of few freedoms, so that few equations close the loops.
/// @throws std::invalid_argument if driven joints and screws close a loop among themselves, or a
///   link is not connected to ground.
std::vector<TreeJoint> SpanningTree(const Mechanism& mechanism,
                                    const std::vector<JointFreedom>& drives);

}  // namespace vmech::peers
