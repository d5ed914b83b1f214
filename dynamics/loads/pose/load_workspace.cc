#include "vmech/dynamics/loads/pose/load_workspace.h"

#include "vmech/base/dual.h"
#include "vmech/base/lanes4.h"

namespace vmech {

template <typename T>
LoadWorkspace<T>::LoadWorkspace(const LoadModel& model)
    : LoadWorkspace(model, DesignOfTree<T>(model.tree)) {}

template <typename T>
LoadWorkspace<T>::LoadWorkspace(const LoadModel& model, const TreeDesign<T>& design)
    : tree(model.tree, design),
      dependents(model.tree, model.partition),
      reactions(model.tree, model.partition, model.compliances),
      joints(model.tree.mechanism.joints.size()),
      inertias(model.tree, design),
      applied(model.tree.nodes.size()),
      cut_passive(model.tree.loops.size()),
      sliding(joints.size(), Vector3<T>::Zero()),
      along(joints.size(), Vector3<T>::Zero()),
      external(model.external.size()),
      q(VectorX::Zero(model.tree.nq)),
      v(VectorX::Zero(model.tree.nv)),
      vdot(VectorX::Zero(model.tree.nv)),
      tau(VectorX::Zero(model.tree.nv)),
      passive(VectorX::Zero(model.tree.nv)),
      open(VectorX::Zero(model.tree.nv)),
      mu(VectorX::Zero(model.tree.rows)),
      loads(joints.size(), {{}, Vector3<T>::Zero(), Vector3<T>::Zero(), Vector3<T>::Zero()}),
      drive_forces(model.drives.size(), T(0)) {
  SetGravity(model.tree.mechanism.gravity_W, &tree);
  const CoordinatePartition& p = model.partition;
  if (model.hand || !p.idle.empty()) {
    motions = MatrixXd::Zero(model.tree.nv, static_cast<int>(p.driven.size() + p.idle.size()));
  }
}

template struct LoadWorkspace<double>;
template struct LoadWorkspace<Dual>;
template struct LoadWorkspace<Lanes4>;

}  // namespace vmech
