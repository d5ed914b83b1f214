#include "vmech/dynamics/loads/pose/load_workspace.h"

#include "vmech/base/dual.h"
#include "vmech/base/lanes4.h"
#include "vmech/base/tape/taped4.h"

namespace vmech {

template <typename T>
LoadWorkspace<T>::LoadWorkspace(const LoadModel& model)
    : LoadWorkspace(model, DesignOf(model.tree.mechanism).template cast<T>(),
                    DesignOfTree<T>(model.tree)) {}

template <typename T>
LoadWorkspace<T>::LoadWorkspace(const LoadModel& model, const Design<T>& design)
    : LoadWorkspace(model, design, DesignOfTree(model.tree, design)) {}

template <typename T>
LoadWorkspace<T>::LoadWorkspace(const LoadModel& model, const Design<T>& design,
                                const TreeDesign<T>& placed)
    : numbers(design.joints),
      gravity_W(design.gravity_W),
      tree(model.tree, placed),
      dependents(model.tree, model.partition),
      reactions(model.tree, model.partition, model.compliances),
      joints(model.tree.mechanism.joints.size()),
      inertias(model.tree, placed),
      applied(model.tree.nodes.size()),
      cut_passive(model.tree.loops.size()),
      sliding(joints.size(), Vector3<T>::Zero()),
      along(joints.size(), Vector3<T>::Zero()),
      external(model.external.size()),
      q(VectorX<T>::Zero(model.tree.nq)),
      v(VectorX<T>::Zero(model.tree.nv)),
      vdot(VectorX<T>::Zero(model.tree.nv)),
      tau(VectorX<T>::Zero(model.tree.nv)),
      passive(VectorX<T>::Zero(model.tree.nv)),
      open(VectorX<T>::Zero(model.tree.nv)),
      mu(VectorX<T>::Zero(model.tree.rows)),
      loads(joints.size(), {{}, Vector3<T>::Zero(), Vector3<T>::Zero(), Vector3<T>::Zero()}),
      drive_forces(model.drives.size(), T(0)) {
  SetGravity(gravity_W, &tree);
  const CoordinatePartition& p = model.partition;
  if (model.hand || !p.idle.empty()) {
    motions.setZero(model.tree.nv, static_cast<int>(p.driven.size() + p.idle.size()));
  }
}

template struct LoadWorkspace<double>;
template struct LoadWorkspace<Dual>;
template struct LoadWorkspace<Taped4>;
template struct LoadWorkspace<Lanes4>;

}  // namespace vmech
