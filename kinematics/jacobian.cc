#include "vmech/kinematics/jacobian.h"

#include "vmech/kinematics/forward_kinematics.h"
#include "vmech/kinematics/packet.h"

namespace vmech {

void PointJacobian(const KinematicTree& tree, const TreeWorkspace<double>& ws, int node,
                   const Vector3d& p_WQ, MatrixXd* J) {
  J->setZero();
  for (int n = node; n >= 0; n = tree.nodes[n].parent) {
    const TreeNode& carrier = tree.nodes[n];
    if (carrier.v < 0) continue;
    const int count = carrier.motion == NodeMotion::kSpherical ? 3 : 1;
    for (int k = 0; k < count; ++k) {
      const JointAxis<double> axis = AxisInWorld(tree, ws, n, k);
      J->col(carrier.v + k) << axis.linear + axis.angular.cross(p_WQ - ws.nodes[n].X_WB.p),
          axis.angular;
    }
  }
}

template <typename T>
Vector6<T> PointTwist(const TreeWorkspace<T>& ws, int node, const Vector3<T>& p_WQ) {
  Vector6<T> V = Vector6<T>::Zero();
  if (node < 0) return V;
  const NodeState<T>& s = ws.nodes[node];
  V << s.v + s.w.cross(p_WQ - s.X_WB.p), s.w;
  return V;
}

Vector6d PointAcceleration(const TreeWorkspace<double>& ws, int node, const Vector3d& p_WQ) {
  Vector6d A = Vector6d::Zero();
  if (node < 0) return A;
  const NodeState<double>& s = ws.nodes[node];
  const Vector3d r = p_WQ - s.X_WB.p;
  A << s.a + s.alpha.cross(r) + s.w.cross(s.w.cross(r)), s.alpha;
  return A;
}

void FreeMotions(const TreeWorkspace<double>& ws, DependentSolver<double>* dependents,
                 MatrixXd* N) {
  const CoordinatePartition& partition = dependents->partition();
  N->setZero();
  Eigen::Index column = 0;
  for (const std::vector<int>* group : {&partition.driven, &partition.idle}) {
    for (int v : *group) {
      (*N)(v, column) = 1;
      dependents->CompleteVelocities(ws, N->col(column).data());
      ++column;
    }
  }
}

template Vector6d PointTwist<double>(const TreeWorkspace<double>&, int, const Vector3d&);
template Vector6<Packet> PointTwist<Packet>(const TreeWorkspace<Packet>&, int,
                                            const Vector3<Packet>&);

}  // namespace vmech
