#include "vmech/dynamics/loads/pose/passive_loads.h"

#include "vmech/base/dual.h"
#include "vmech/base/lanes4.h"
#include "vmech/base/tape/taped4.h"
#include "vmech/dynamics/loads/pose/contact_friction.h"
#include "vmech/dynamics/rigid_body/passive.h"
#include "vmech/kinematics/loops/cut_joint.h"
#include "vmech/kinematics/loops/loops.h"

namespace vmech {

template <typename T>
void SpreadPassive(const LoadModel& model, LoadWorkspace<T>* ws) {
  for (const TreeNode& node : model.tree.nodes) {
    for (int k = 0; k < VelocitiesOf(node.motion); ++k) {
      ws->passive[node.v + k] = ws->along[node.joint][node.freedom + k];
    }
  }
  for (size_t l = 0; l < model.tree.loops.size(); ++l) {
    const CutJointFreedoms<T> freedoms = FreedomsOfCutJoint(model.tree.loops[l], ws->tree.loops[l]);
    const Vector3<T>& along = ws->along[model.tree.loops[l].joint];
    Vector6<T> W_F = Vector6<T>::Zero();
    for (int k = 0; k < freedoms.count; ++k) {
      // A twist of unit rate against which the force does work; exact for the screw as well.
      const Vector6<T>& S = freedoms.twist_F[k];
      W_F += S * (along[k] / S.squaredNorm());
    }
    ws->cut_passive[l] = {W_F.template head<3>(), W_F.template tail<3>()};
  }
}

template <typename T>
void PassiveForces(const LoadModel& model, LoadWorkspace<T>* ws) {
  for (size_t j = 0; j < ws->loads.size(); ++j) {
    const Joint& joint = model.tree.mechanism.joints[j];
    const JointLoad<T>& load = ws->loads[j];
    const typename Design<T>::JointNumbers& numbers = ws->numbers[j];
    ws->along[j].setZero();
    if (HasDryFriction(joint)) {
      const Vector3<T> limits =
          FrictionLimits<T>(joint.type, numbers, load.W_F, load.position, ws->sliding[j]);
      ws->along[j] = SlidingFriction(joint.type, limits, ws->sliding[j]);
    }
    for (int k = 0; k < static_cast<int>(joint.passive.size()); ++k) {
      ws->along[j][k] += SpringForce(numbers.passive[k], load.position[k], load.rate[k]);
    }
    if (ws->exerted != nullptr) ws->along[j] += ws->exerted[j];
  }
  SpreadPassive(model, ws);
}

int LockingJoint(const LoadModel& model, const LoadWorkspace<double>& ws, bool settled) {
  int locking = -1;
  double largest = 0;
  for (size_t j = 0; j < ws.loads.size(); ++j) {
    const Joint& joint = model.tree.mechanism.joints[j];
    if (ThreadLocks(joint, ws.loads[j].W_F, ws.sliding[j][0])) return static_cast<int>(j);
    const Vector3d limits =
        FrictionLimits(joint, ws.loads[j].W_F, ws.loads[j].position, ws.sliding[j]);
    const double power = limits.cwiseProduct(ws.sliding[j]).norm();
    if (settled || joint.load_friction.coefficient == 0 || power <= largest) continue;
    largest = power;
    locking = static_cast<int>(j);
  }
  return locking;
}

// NOLINTBEGIN(bugprone-macro-parentheses): T is a type
#define VMECH_INSTANTIATE(T)                                           \
  template void PassiveForces<T>(const LoadModel&, LoadWorkspace<T>*); \
  template void SpreadPassive<T>(const LoadModel&, LoadWorkspace<T>*);
VMECH_INSTANTIATE(double)
VMECH_INSTANTIATE(Dual)
VMECH_INSTANTIATE(Taped4)
VMECH_INSTANTIATE(Lanes4)
#undef VMECH_INSTANTIATE
// NOLINTEND(bugprone-macro-parentheses)

}  // namespace vmech
