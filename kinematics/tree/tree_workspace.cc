#include "vmech/kinematics/tree/tree_workspace.h"

#include "vmech/base/dual.h"
#include "vmech/base/lanes4.h"
#include "vmech/base/screw_algebra.h"
#include "vmech/base/tape/taped4.h"

namespace vmech {

template <typename T>
TreeWorkspace<T>::TreeWorkspace(const KinematicTree& tree)
    : TreeWorkspace(tree, DesignOfTree<T>(tree)) {}

template <typename T>
TreeWorkspace<T>::TreeWorkspace(const KinematicTree& tree, const TreeDesign<T>& design)
    : reference(tree.reference),
      nodes(tree.nodes.size() + 1),
      S(tree.nv),
      placements(design.placements.size()),
      loops(tree.loops.size()),
      sine(PaddedSize(static_cast<int>(tree.revolute_coordinates.size()))),
      cosine(sine) {
  at(-1).X.p = TripleOf<T>(-reference.cast<T>());
  Take(tree, design);
  int columns = 0;
  for (const Loop& loop : tree.loops) {
    first_column.push_back(columns);
    columns += static_cast<int>(loop.columns.size());
  }
  loop_columns.assign(columns, Vector6<T>::Zero());
}

template <typename T>
void TreeWorkspace<T>::Take(const KinematicTree& tree, const TreeDesign<T>& design) noexcept {
  for (size_t i = 0; i < design.nodes.size(); ++i) {
    nodes[i + 1].X_PF = FrameOf(design.nodes[i].X_PF);
    nodes[i + 1].X_BL = FrameOf(design.nodes[i].X_BL);
    nodes[i + 1].pitch = design.nodes[i].pitch;
  }
  for (size_t j = 0; j < placements.size(); ++j) {
    placements[j] = {FrameOf(design.placements[j].X_AF), FrameOf(design.placements[j].X_BM)};
  }
  for (size_t l = 0; l < loops.size(); ++l) {
    loops[l].pitch = design.placements[tree.loops[l].joint].pitch;
  }
}

template struct TreeWorkspace<double>;
template struct TreeWorkspace<Dual>;
template struct TreeWorkspace<Taped4>;
template struct TreeWorkspace<Lanes4>;

}  // namespace vmech
