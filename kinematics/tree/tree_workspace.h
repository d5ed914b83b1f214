#pragma once

#include <vector>

#include "vmech/base/four.h"
#include "vmech/kinematics/tree/kinematic_tree.h"

namespace vmech {

/// The state of one node; everything expressed in world axes.
template <typename T>
struct NodeState {
  Pose<T> X_WB;     ///< its z axis is that of the node's elementary joint
  Vector3<T> w, v;  ///< angular velocity; velocity of Bo
  Vector3<T> alpha, a;
  Wrench<T> F_Bo;  ///< what the parent exerts on this node, about Bo
};

/// The state of one loop. F and M are the anchors of the cut joint.
template <typename T>
struct LoopState {
  Matrix3<T> R_WF;
  Vector3<T> p_WM;
  Vector3<T> p_FM_W;  ///< from F to M, world axes
  Matrix3<T> R_FM;
  Vector3<T> n_F;   ///< kUniversal: y_M x x_F, the direction that is neither axis, in F
  Vector6<T> e2;    ///< paper's e2: what is left to close the loop; the first `rows` entries
  Vector6<T> bias;  ///< C' v-part: relative acceleration in the closed directions when v' = 0
};

/// Memory for the computations on one tree, sized once. A pose is written by ForwardKinematics and
/// then only read until the next; each algorithm says which fields it needs and which it writes.
template <typename T>
struct TreeWorkspace {
  explicit TreeWorkspace(const KinematicTree& tree);

  std::vector<NodeState<T>> nodes;
  std::vector<LoopState<T>> loops;
  /// Columns of C, loop after loop in the order of Loop::columns; the first `rows` entries count.
  std::vector<Vector6<T>> loop_columns;
  std::vector<int> first_column;  ///< of each loop in loop_columns
  std::vector<T> sine, cosine;    ///< of KinematicTree::turning, see Sines
};

template <typename T>
TreeWorkspace<T>::TreeWorkspace(const KinematicTree& tree)
    : nodes(tree.nodes.size()),
      loops(tree.loops.size()),
      sine(PaddedSize(static_cast<int>(tree.turning.size()))),
      cosine(sine) {
  int columns = 0;
  for (const Loop& loop : tree.loops) {
    first_column.push_back(columns);
    columns += static_cast<int>(loop.columns.size());
  }
  loop_columns.assign(columns, Vector6<T>::Zero());
}

}  // namespace vmech
