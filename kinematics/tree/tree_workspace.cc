#include "vmech/kinematics/tree/tree_workspace.h"

#include "vmech/base/packet.h"
#include "vmech/base/screw_algebra.h"

namespace vmech {

template <typename T>
TreeWorkspace<T>::TreeWorkspace(const KinematicTree& tree)
    : reference(tree.reference),
      nodes(tree.nodes.size() + 1),
      S(tree.nv),
      loops(tree.loops.size()),
      sine(PaddedSize(static_cast<int>(tree.revolute_coordinates.size()))),
      cosine(sine) {
  at(-1).X.p = TripleOf<T>(-reference);
  for (size_t i = 0; i < tree.nodes.size(); ++i) nodes[i + 1].X_PF = FrameOf<T>(tree.nodes[i].X_PF);
  for (const JointPlacement& place : tree.placements) {
    placements.push_back({FrameOf<T>(place.X_AF), FrameOf<T>(place.X_BM)});
  }
  int columns = 0;
  for (const Loop& loop : tree.loops) {
    first_column.push_back(columns);
    columns += static_cast<int>(loop.columns.size());
  }
  loop_columns.assign(columns, Vector6<T>::Zero());
}

template struct TreeWorkspace<double>;
template struct TreeWorkspace<Packet>;

}  // namespace vmech
