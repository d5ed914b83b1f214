#include "vmech/dynamics/loads/pose/store_pose_loads.h"

#include "vmech/base/lanes4.h"
#include "vmech/base/screw_algebra.h"
#include "vmech/dynamics/loads/pose/hand_wrench.h"

namespace vmech {
namespace {

template <typename T>
void StoreJoints(size_t pose, const LoadWorkspace<T>& ws, LoadArrays* arrays) {
  const size_t joints = arrays->joint_count(), freedoms = arrays->freedom_count();
  double* wrench = arrays->wrenches.data() + 6 * joints * pose;
  double* position = arrays->positions.data() + freedoms * pose;
  double* rate = arrays->rates.data() + freedoms * pose;
  double* acceleration = arrays->accelerations.data() + freedoms * pose;
  for (size_t j = 0; j < joints; ++j) {
    const JointLoad<T>& load = ws.loads[j];
    const int first = arrays->first_freedom[j], count = arrays->first_freedom[j + 1] - first;
    StoreLanes(load.W_F.Stacked().data(), 6, wrench + 6 * j, 6 * joints);
    StoreLanes(load.position.data(), count, position + first, freedoms);
    StoreLanes(load.rate.data(), count, rate + first, freedoms);
    StoreLanes(load.acceleration.data(), count, acceleration + first, freedoms);
  }
}

/// Motion of a link's drawing frame, world axes.
template <typename T>
void StoreLinkMotion(const TreeWorkspace<T>& tree, int node, size_t stride, LinkMotion* motions) {
  const typename TreeWorkspace<T>::Node& s = tree.at(node);
  const FrameT<T> L = s.X * s.X_BL;
  const ScrewT<T> A = s.A - tree.at(-1).A;
  const Triple<T> v = VelocityAt(L.p, s.V);
  const Triple<T> a = VelocityAt(L.p, A) + Cross(s.V.angular, v);
  const Pose<T> X = PoseOf(L);
  for (int lane = 0; lane < kLanesOf<T>; ++lane) {
    LinkMotion& motion = motions[lane * stride];
    motion.X_WL = {Lane(X.R, lane), Lane(X.p, lane) + tree.reference};
    motion.v = Lane(Vector3Of(v), lane);
    motion.w = Lane(Vector3Of(s.V.angular), lane);
    motion.a = Lane(Vector3Of(a), lane);
    motion.alpha = Lane(Vector3Of(A.angular), lane);
  }
}

template <typename T>
void StoreLinks(const LoadModel& model, size_t pose, const LoadWorkspace<T>& ws,
                LoadArrays* arrays) {
  const size_t links = arrays->link_count;
  for (size_t link = 0; link < links; ++link) {
    const int index = model.tree.NodeOfLink(static_cast<int>(link));
    if (index < 0) continue;
    StoreLinkMotion(ws.tree, index, links, &arrays->links[pose * links + link]);
  }
}

}  // namespace

LoadArrays MakeLoadArrays(const LoadModel& model, const Motion& motion, bool link_motions) {
  const Mechanism& mechanism = model.tree.mechanism;
  LoadArrays arrays({motion.size(), model.drives.size(), FreedomsOfJoints(mechanism),
                     link_motions ? mechanism.links.size() : 0, model.hand.has_value(),
                     model.has_dry_friction || model.idle > 0});
  arrays.times = motion.times;
  arrays.drives = motion.drives;
  return arrays;
}

template <typename T>
void StorePoseLoads(const LoadModel& model, const Motion& motion, size_t pose,
                    const LoadWorkspace<T>& ws, LoadArrays* arrays) {
  const size_t drives = arrays->drive_count;
  StoreLanes(ws.drive_forces.data(), static_cast<int>(drives),
             arrays->drive_forces.data() + drives * pose, drives);
  StoreJoints(pose, ws, arrays);
  StoreLanes(&ws.power, 1, &arrays->powers[pose], 1);
  StoreLanes(&ws.power_gap, 1, &arrays->power_errors[pose], 1);
  StoreLanes(&ws.power_size, 1, &arrays->power_error_scales[pose], 1);
  StoreLanes(&ws.dependents.smallest_pivot(), 1, &arrays->smallest_pivots[pose], 1);
  StoreLanes(&ws.closure, 1, &arrays->closures[pose], 1);
  StoreLinks(model, pose, ws, arrays);
  for (int lane = 0; !arrays->states.empty() && lane < kLanesOf<T>; ++lane) {
    arrays->states[pose + lane] = {ws.unresisted, ws.along_idle, ws.jammed, ws.locking_joint,
                                   ws.held_by_friction};
  }
  if constexpr (kLanesOf<T> == 1) {
    if (!model.hand) return;
    const double error = (motion.hand[pose].X_WH.p - GraspPose(model, ws.tree).p).norm();
    arrays->hands[pose] = {ws.hand, error};
  }
}

// NOLINTBEGIN(bugprone-macro-parentheses): T is a type
#define VMECH_INSTANTIATE(T)                                               \
  template void StorePoseLoads<T>(const LoadModel&, const Motion&, size_t, \
                                  const LoadWorkspace<T>&, LoadArrays*);
VMECH_INSTANTIATE(double)
VMECH_INSTANTIATE(Lanes4)
#undef VMECH_INSTANTIATE
// NOLINTEND(bugprone-macro-parentheses)

}  // namespace vmech
