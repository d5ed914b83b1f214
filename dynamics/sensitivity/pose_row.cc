#include "vmech/dynamics/sensitivity/pose_row.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "vmech/base/dual.h"
#include "vmech/base/lanes4.h"
#include "vmech/base/screw_algebra.h"
#include "vmech/base/tape/taped4.h"
#include "vmech/dynamics/loads/load_arrays.h"
#include "vmech/dynamics/loads/pose/resting_friction.h"

namespace vmech {
namespace {

template <typename T>
Vector3<T> GroundForce(const Mechanism& mechanism, const LoadWorkspace<T>& ws) {
  Vector3<T> force = Vector3<T>::Zero();
  for (size_t j = 0; j < mechanism.joints.size(); ++j) {
    const Vector3<T> on_second = Vector3Of(ws.joints[j].W.linear);
    if (mechanism.joints[j].first.link == mechanism.ground) force += on_second;
    if (mechanism.joints[j].second.link == mechanism.ground) force -= on_second;
  }
  return force;
}

template <typename T>
Eigen::Vector<T, 6> AxisOf(const LoadWorkspace<T>& ws, size_t joint) {
  const FrameT<T>& F = ws.joints[joint].F;
  Eigen::Vector<T, 6> axis;
  axis << Vector3Of(F.p) + ws.tree.reference.template cast<T>(), Vector3Of(F.z);
  return axis;
}

template <typename T>
Vector3<T> OriginOf(const Grasp& grasp, const Vector3<T>& p_LG, const LoadModel& model,
                    const LoadWorkspace<T>& ws) {
  const int node = model.tree.NodeOfLink(grasp.link);
  const FrameT<T> X_WL = ws.tree.at(node).X * ws.tree.at(node).X_BL;
  return Vector3Of(PointInWorld(X_WL, TripleOf<T>(p_LG))) + ws.tree.reference.template cast<T>();
}

}  // namespace

LoadLayout::LoadLayout(const LoadModel& model)
    : joints(model.tree.mechanism.joints.size()),
      grasps(model.tree.mechanism.grasps.size()),
      drives(model.drives.size()),
      first_freedom{0} {
  for (int freedoms : FreedomsOfJoints(model.tree.mechanism)) {
    first_freedom.push_back(first_freedom.back() + freedoms);
  }
}

template <typename T>
void FillRow(const LoadModel& model, const std::vector<Vector3<T>>& p_LG,
             const LoadWorkspace<T>& ws, const LoadLayout& layout, T* row) {
  const Mechanism& mechanism = model.tree.mechanism;
  const auto put = [&](size_t at, const auto& numbers, int count) {
    std::copy_n(numbers.data(), count, row + at);
  };
  for (size_t j = 0; j < layout.joints; ++j) {
    const JointLoad<T>& load = ws.loads[j];
    put(layout.wrench(j), load.W_F.Stacked(), 6);
    put(layout.axis(j), AxisOf(ws, j), 6);
    put(layout.rate(j), load.rate, layout.first_freedom[j + 1] - layout.first_freedom[j]);
  }
  put(layout.ground_force(), GroundForce(mechanism, ws), 3);
  for (size_t g = 0; g < layout.grasps; ++g) {
    put(layout.grasp(g), OriginOf<T>(mechanism.grasps[g], p_LG[g], model, ws), 3);
  }
  put(layout.drive_force(0), ws.drive_forces, static_cast<int>(layout.drives));
}

void RefusePose(const LoadModel& model, const Motion& motion, size_t pose, size_t number) {
  const bool rests = model.has_dry_friction && AnyStands(model, motion, pose, 1);
  throw std::runtime_error(fmt::format(
      "pose {} (t = {:.6g} s): {}, so that its loads have no derivative. {}", number,
      motion.times[pose],
      rests ? "a drive stands still and dry friction holds" : "the mechanism is at a dead centre",
      rests ? "Leave the pose out of the study" : "Choose another start or number of steps"));
}

// NOLINTBEGIN(bugprone-macro-parentheses): T is a type
#define VMECH_INSTANTIATE(T)                                                 \
  template void FillRow<T>(const LoadModel&, const std::vector<Vector3<T>>&, \
                           const LoadWorkspace<T>&, const LoadLayout&, T*);
VMECH_INSTANTIATE(double)
VMECH_INSTANTIATE(Dual)
VMECH_INSTANTIATE(Taped4)
VMECH_INSTANTIATE(Lanes4)
#undef VMECH_INSTANTIATE
// NOLINTEND(bugprone-macro-parentheses)

}  // namespace vmech
