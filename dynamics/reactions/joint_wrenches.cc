#include "vmech/dynamics/reactions/joint_wrenches.h"

#include "vmech/base/dual.h"
#include "vmech/base/lanes4.h"
#include "vmech/base/screw_algebra.h"
#include "vmech/base/tape/taped4.h"
#include "vmech/kinematics/loops/loops.h"

namespace vmech {

template <typename T>
void JointFrames(const KinematicTree& tree, const TreeWorkspace<T>& ws,
                 std::vector<JointState<T>>* joints) noexcept {
  using std::sqrt;
  for (size_t j = 0; j < joints->size(); ++j) {
    const JointPlacement& place = tree.placements[j];
    const typename TreeWorkspace<T>::Placement& anchors = ws.placements[j];
    const FrameT<T>&A = ws.at(place.first_node).X, &B = ws.at(place.second_node).X;
    JointState<T>& joint = (*joints)[j];
    joint.F = {Rotate(A, anchors.X_AF.x), Rotate(A, anchors.X_AF.y), Rotate(A, anchors.X_AF.z),
               PointInWorld(B, anchors.X_BM.p)};
    if (tree.mechanism.joints[j].type != JointType::kUniversal) continue;
    const Triple<T> across = Cross(Rotate(B, anchors.X_BM.y), joint.F.x);
    joint.across = across / sqrt(Dot(across, across));
  }
}

template <typename T>
void TreeJointWrenches(const KinematicTree& tree, const TreeWorkspace<T>& ws,
                       std::vector<JointState<T>>* joints) noexcept {
  for (size_t j = 0; j < joints->size(); ++j) {
    const int node = tree.placements[j].tree_node;
    if (node < 0) continue;
    (*joints)[j].W = (tree.nodes[node].reversed ? -1.0 : 1.0) * ws.at(node).F;
  }
}

template <typename T>
void ApplyAlongBranch(const KinematicTree& tree, int node, const ScrewT<T>& W,
                      TreeWorkspace<T>* ws) noexcept {
  for (int n = node; n >= 0; n = tree.nodes[n].parent) ws->at(n).F -= W;
}

template <typename T>
void ApplyAroundLoop(const Loop& loop, const ScrewT<T>& W, TreeWorkspace<T>* ws) noexcept {
  for (const LoopNode& n : loop.path) ws->at(n.node).F -= n.sign * W;
}

template <typename T>
void ApplyMultipliers(const KinematicTree& tree, const T* mu, TreeWorkspace<T>* ws,
                      std::vector<JointState<T>>* joints) noexcept {
  for (size_t l = 0; l < tree.loops.size(); ++l) {
    const Loop& loop = tree.loops[l];
    const ScrewT<T> W = LoopWrench(loop, ws->loops[l], mu + loop.row);
    ApplyAroundLoop(loop, W, ws);
    (*joints)[loop.joint].W = W;
  }
  TreeJointWrenches(tree, *ws, joints);
}

// NOLINTBEGIN(bugprone-macro-parentheses): T is a type
#define VMECH_INSTANTIATE(T)                                                                   \
  template void JointFrames<T>(const KinematicTree&, const TreeWorkspace<T>&,                  \
                               std::vector<JointState<T>>*) noexcept;                          \
  template void TreeJointWrenches<T>(const KinematicTree&, const TreeWorkspace<T>&,            \
                                     std::vector<JointState<T>>*) noexcept;                    \
  template void ApplyAlongBranch<T>(const KinematicTree&, int, const ScrewT<T>&,               \
                                    TreeWorkspace<T>*) noexcept;                               \
  template void ApplyAroundLoop<T>(const Loop&, const ScrewT<T>&, TreeWorkspace<T>*) noexcept; \
  template void ApplyMultipliers<T>(const KinematicTree&, const T*, TreeWorkspace<T>*,         \
                                    std::vector<JointState<T>>*) noexcept;
VMECH_INSTANTIATE(double)
VMECH_INSTANTIATE(Dual)
VMECH_INSTANTIATE(Taped4)
VMECH_INSTANTIATE(Lanes4)
#undef VMECH_INSTANTIATE
// NOLINTEND(bugprone-macro-parentheses)

}  // namespace vmech
