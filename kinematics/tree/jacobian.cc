#include "vmech/kinematics/tree/jacobian.h"

#include "vmech/base/packet.h"
#include "vmech/kinematics/tree/forward_kinematics.h"

namespace vmech {

void PointJacobian(const KinematicTree& tree, const TreeWorkspace<double>& ws, int node,
                   const Vector3d& p_WQ, Matrix6Xd* J) {
  J->setZero();
  for (int n = node; n >= 0; n = tree.nodes[n].parent) {
    const TreeNode& carrier = tree.nodes[n];
    if (carrier.v < 0) continue;
    const int count = carrier.motion == NodeMotion::kSpherical ? 3 : 1;
    for (int k = 0; k < count; ++k) {
      J->col(carrier.v + k) = UnitTwistAt(tree, ws, n, k, p_WQ);
    }
  }
}

template <typename T>
Vector6<T> PointTwist(const TreeWorkspace<T>& ws, int node, const Vector3<T>& p_WQ) {
  if (node < 0) return Vector6<T>::Zero();
  const NodeState<T>& s = ws.nodes[node];
  return Stacked<T>(s.v + s.w.cross(p_WQ - s.X_WB.p), s.w);
}

Vector6d PointAcceleration(const TreeWorkspace<double>& ws, int node, const Vector3d& p_WQ) {
  if (node < 0) return Vector6d::Zero();
  const NodeState<double>& s = ws.nodes[node];
  const Vector3d r = p_WQ - s.X_WB.p;
  return Stacked<double>(s.a + s.alpha.cross(r) + s.w.cross(s.w.cross(r)), s.alpha);
}

template Vector6d PointTwist<double>(const TreeWorkspace<double>&, int, const Vector3d&);
template Vector6<Packet> PointTwist<Packet>(const TreeWorkspace<Packet>&, int,
                                            const Vector3<Packet>&);

}  // namespace vmech
