#include "vmech/dynamics/loads/pose/joint_load.h"

#include <cmath>

#include "vmech/base/dual.h"
#include "vmech/base/lanes4.h"
#include "vmech/base/tape/taped4.h"
#include "vmech/kinematics/loops/cut_joint.h"

namespace vmech {
namespace {

/// The rotation vector of a unit quaternion (w, x, y, z).
template <typename T>
Vector3<T> RotationVector(const T* wxyz) {
  using std::atan2;
  using std::sqrt;
  const T sign = Select(wxyz[0] < T(0), T(-1), T(1));  // the shorter way round
  const Vector3<T> xyz = sign * Vector3<T>(wxyz[1], wxyz[2], wxyz[3]);
  const T w = sign * wxyz[0], sine2 = xyz.squaredNorm();
  constexpr double kSmall = 1e-16;  // squared: there the series has the same digits
  const T sine = sqrt(Select(sine2 < T(kSmall), T(1), sine2));
  const T per_sine = Select(sine2 < T(kSmall), T(2.0), 2.0 * atan2(sine, w) / sine);
  return per_sine * xyz;
}

}  // namespace

template <typename T>
void TreeJointPositions(const KinematicTree& tree, const T* q, std::vector<JointLoad<T>>* joints) {
  for (const TreeNode& node : tree.nodes) {
    if (node.v < 0) continue;
    JointLoad<T>& joint = (*joints)[node.joint];
    if (node.motion == NodeMotion::kSpherical) {
      joint.position = RotationVector<T>(q + node.q);
    } else {
      joint.position[node.freedom] = q[node.q];
    }
  }
}

template <typename T>
void JointRates(const KinematicTree& tree, const TreeWorkspace<T>& ws, const T* v,
                std::vector<JointLoad<T>>* joints) {
  for (const TreeNode& node : tree.nodes) {
    for (int k = 0; k < VelocitiesOf(node.motion); ++k) {
      (*joints)[node.joint].rate[node.freedom + k] = v[node.v + k];
    }
  }
  for (size_t l = 0; l < tree.loops.size(); ++l) {
    (*joints)[tree.loops[l].joint].rate = CutJointRates(tree, ws, static_cast<int>(l));
  }
}

template <typename T>
void JointAccelerations(const KinematicTree& tree, const TreeWorkspace<T>& ws, const T* vdot,
                        std::vector<JointLoad<T>>* joints) {
  for (const TreeNode& node : tree.nodes) {
    for (int k = 0; k < VelocitiesOf(node.motion); ++k) {
      (*joints)[node.joint].acceleration[node.freedom + k] = vdot[node.v + k];
    }
  }
  for (size_t l = 0; l < tree.loops.size(); ++l) {
    (*joints)[tree.loops[l].joint].acceleration =
        CutJointAccelerations(tree, ws, static_cast<int>(l));
  }
}

// NOLINTBEGIN(bugprone-macro-parentheses): T is a type
#define VMECH_INSTANTIATE(T)                                                                       \
  template void TreeJointPositions<T>(const KinematicTree&, const T*, std::vector<JointLoad<T>>*); \
  template void JointRates<T>(const KinematicTree&, const TreeWorkspace<T>&, const T*,             \
                              std::vector<JointLoad<T>>*);                                         \
  template void JointAccelerations<T>(const KinematicTree&, const TreeWorkspace<T>&, const T*,     \
                                      std::vector<JointLoad<T>>*);
VMECH_INSTANTIATE(double)
VMECH_INSTANTIATE(Dual)
VMECH_INSTANTIATE(Taped4)
VMECH_INSTANTIATE(Lanes4)
#undef VMECH_INSTANTIATE
// NOLINTEND(bugprone-macro-parentheses)

}  // namespace vmech
