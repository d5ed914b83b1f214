#pragma once

#include <vector>

#include "vmech/mechanisms/mechanism.h"

namespace vmech {

/// Links are vertices, joints are edges, the ground link is the root. A spanning tree reaches
/// every link; each joint left over is cut and closes one loop.
struct SpanningTree {
  /// A joint that the tree passes, from the link nearer to the ground.
  struct Branch {
    int joint;        ///< index in Mechanism::joints
    int parent_link;  ///< nearer to the ground
    int child_link;   ///< the other one
  };
  std::vector<Branch> branches;  ///< parents before children, depth first
  std::vector<int> cuts;         ///< indices of the cut joints, in file order
};

/// Which joints the spanning tree keeps, and which it cuts.
struct SpanningTreeOptions {
  /// Joints that must not be cut (the driven ones). A preferred cut that is also kept stays whole.
  std::vector<int> keep;
  /// Joints to cut if the graph allows it, before any rule is asked; overrides the mechanism's own.
  std::vector<int> cut;
  /// Joints that stay whole where the kept ones and the other preferred ones let them.
  std::vector<int> prefer = {};
};

/// Cuts where it costs least: the joint with the most freedoms; on a tie, the one farthest from the
/// ground, which leaves the two branches of a loop most even; then the later one in the file.
/// @throws std::invalid_argument as RequireValid; naming the links that no chain of joints connects
///         to the ground, or a kept joint that cannot be kept because the kept joints close a loop.
SpanningTree FindSpanningTree(const Mechanism& mechanism, const SpanningTreeOptions& options = {});

}  // namespace vmech
