#pragma once

#include <vector>

#include "vmech/base/screw.h"
#include "vmech/kinematics/tree/kinematic_tree.h"

namespace vmech {

/// The state of one loop. F and M are the anchors of the cut joint on its first and second link.
template <typename T>
struct LoopState {
  T pitch = T(0);       ///< kScrew [m/rad]
  FrameT<T> F;          ///< axes of F at the origin of M
  Matrix3<T> R_FM;      ///< M in F
  Vector3<T> p_FM;      ///< origin of M from that of F, axes of F [m]
  Vector3<T> n_F;       ///< kUniversal: y_M x x_F, the direction that is neither axis, in F
  Vector6<T> e2;        ///< paper's e2: what is left to close the loop; the first `rows` entries
  Vector6<T> bias;      ///< dC/dt v: relative acceleration in the closed directions when v' = 0
  ScrewT<T> wrench[6];  ///< what a unit multiplier of each equation does to the second link
};

/// Memory for the computations on one tree, sized once. A pose is written by ForwardKinematics and
/// then only read until the next; each algorithm says which fields it needs and which it writes.
///
/// Everything is expressed in world axes about the tree's reference point, to which the mechanism
/// is near, so that no digits are lost far from the world's origin.
template <typename T>
struct TreeWorkspace {
  /// Keeps a reference to the tree, and takes its numbers.
  explicit TreeWorkspace(const KinematicTree& tree);
  /// With other numbers than the tree's.
  TreeWorkspace(const KinematicTree& tree, const TreeDesign<T>& design);

  /// Takes other numbers of the same tree. Poses and all that comes of them are not valid any more.
  void Take(const KinematicTree& tree, const TreeDesign<T>& design) noexcept;

  /// Node i is at i + 1; the ground comes first.
  struct Node {
    FrameT<T> X_PF;  ///< as in TreeNode
    FrameT<T> X_BL;  ///< as in TreeNode
    T pitch = T(0);  ///< of a screw [m/rad]
    FrameT<T> X;     ///< pose; its z axis is that of the node's elementary joint
    ScrewT<T> V;     ///< twist
    ScrewT<T> c;     ///< velocity product: what A would be if the parent's A and v' were zero
    ScrewT<T> A;     ///< rate of V, and what SetGravity has given the ground
    ScrewT<T> p;     ///< velocity product: what F would be if A were zero
    ScrewT<T> F;     ///< what the parent exerts on this node
  };
  /// Where the anchors of a joint are: as in JointPlacement.
  struct Placement {
    FrameT<T> X_AF, X_BM;  ///< as in JointPlacement
  };

  Vector3d reference;                 ///< the point that everything is about, in the world [m]
  std::vector<Node> nodes;            ///< the ground, then the tree's
  std::vector<ScrewT<T>> S;           ///< twist of each unit velocity [nv]
  std::vector<Placement> placements;  ///< per joint of the mechanism
  std::vector<LoopState<T>> loops;    ///< in the order of KinematicTree::loops
  /// Columns of C, loop after loop in the order of Loop::columns; the first `rows` entries count.
  std::vector<Vector6<T>> loop_columns;
  std::vector<int> first_column;  ///< of each loop in loop_columns
  std::vector<T> sine, cosine;    ///< of the coordinates that are angles

  const Node& at(int node) const { return nodes[node + 1]; }  ///< of the tree; -1 is the ground
  Node& at(int node) { return nodes[node + 1]; }              ///< of the tree; -1 is the ground

  /// Where the columns of a loop begin; a loop between links that are one piece has none.
  const Vector6<T>* columns(size_t loop) const { return loop_columns.data() + first_column[loop]; }
  Vector6<T>* columns(size_t loop) { return loop_columns.data() + first_column[loop]; }  ///< same
};

}  // namespace vmech
