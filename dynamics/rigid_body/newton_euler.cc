#include "vmech/dynamics/rigid_body/newton_euler.h"

#include "vmech/base/packet.h"
#include "vmech/kinematics/tree/forward_kinematics.h"
#include "vmech/kinematics/tree/jacobian.h"

namespace vmech {
namespace {

/// Wrench about Bo that moves a node against its inertia and gravity.
template <typename T>
Wrench<T> InertiaWrench(const TreeNode& node, const NodeState<T>& s, const Vector3d& gravity_W) {
  const Matrix3<T>& R = s.X_WB.R;
  const Vector3<T> c = R * node.p_BoBcm.cast<T>();
  const Vector3<T> a_cm = s.a + s.alpha.cross(c) + s.w.cross(s.w.cross(c));
  const Vector3<T> f = node.mass * (a_cm - gravity_W.cast<T>());
  const Vector3<T> w_B = R.transpose() * s.w;
  const Vector3<T> alpha_B = R.transpose() * s.alpha;
  const Matrix3<T> I = node.I_Bcm.cast<T>();
  // Euler's equation in the node's own axes.
  const Vector3<T> n_B = I * alpha_B + w_B.cross(I * w_B);
  return {f, R * n_B + c.cross(f)};
}

}  // namespace

template <typename T>
void RecursiveNewtonEuler(const KinematicTree& tree, const Vector3d& gravity_W,
                          const Wrench<T>* applied, TreeWorkspace<T>* ws) {
  for (size_t i = 0; i < tree.nodes.size(); ++i) {
    const TreeNode& node = tree.nodes[i];
    NodeState<T>& s = ws->nodes[i];
    s.F_Bo = node.link >= 0 ? InertiaWrench(node, s, gravity_W) - applied[i] : -applied[i];
  }
  for (size_t i = tree.nodes.size(); i-- > 0;) {
    const int parent = tree.nodes[i].parent;
    if (parent < 0) continue;
    const NodeState<T>& s = ws->nodes[i];
    NodeState<T>& p = ws->nodes[parent];
    p.F_Bo += s.F_Bo.ShiftedBy(s.X_WB.p - p.X_WB.p);
  }
}

template <typename T>
void GeneralisedForces(const KinematicTree& tree, const TreeWorkspace<T>& ws, T* tau) {
  for (size_t i = 0; i < tree.nodes.size(); ++i) {
    const TreeNode& node = tree.nodes[i];
    if (node.v < 0) continue;
    const Wrench<T>& F = ws.nodes[i].F_Bo;
    const Vector3<T>& z = ws.nodes[i].X_WB.R.col(2);
    switch (node.motion) {
      case NodeMotion::kFixed:
        break;
      case NodeMotion::kRevolute:
        tau[node.v] = z.dot(F.moment);
        break;
      case NodeMotion::kPrismatic:
        tau[node.v] = z.dot(F.force);
        break;
      case NodeMotion::kScrew:
        tau[node.v] = z.dot(F.moment) + node.pitch * z.dot(F.force);
        break;
      case NodeMotion::kSpherical:
        for (int k = 0; k < 3; ++k) {
          tau[node.v + k] = AxisInWorld(tree, ws, static_cast<int>(i), k).angular.dot(F.moment);
        }
        break;
    }
  }
}

MatrixXd MassMatrix(const KinematicTree& tree, const VectorXd& q) {
  TreeWorkspace<double> ws(tree);
  ForwardKinematics(tree, q.data(), &ws);
  MatrixXd M = MatrixXd::Zero(tree.nv, tree.nv);
  Matrix6Xd J(6, tree.nv);
  for (size_t i = 0; i < tree.nodes.size(); ++i) {
    const TreeNode& node = tree.nodes[i];
    if (node.link < 0) continue;
    const Matrix3d& R = ws.nodes[i].X_WB.R;
    PointJacobian(tree, ws, static_cast<int>(i), ws.nodes[i].X_WB * node.p_BoBcm, &J);
    M += node.mass * J.topRows(3).transpose() * J.topRows(3) +
         J.bottomRows(3).transpose() * (R * node.I_Bcm * R.transpose()) * J.bottomRows(3);
  }
  return M;
}

VectorXd BiasForces(const KinematicTree& tree, const VectorXd& q, const VectorXd& v) {
  TreeWorkspace<double> ws(tree);
  const std::vector<Wrenchd> nothing(tree.nodes.size());
  ForwardKinematics(tree, q.data(), &ws);
  ForwardVelocities(tree, v.data(), &ws);
  ForwardAccelerations<double>(tree, v.data(), nullptr, &ws);
  RecursiveNewtonEuler<double>(tree, tree.mechanism.gravity_W, nothing.data(), &ws);
  VectorXd h = VectorXd::Zero(tree.nv);
  GeneralisedForces(tree, ws, h.data());
  return h;
}

// NOLINTBEGIN(bugprone-macro-parentheses): T is a type
#define VMECH_INSTANTIATE(T)                                                                     \
  template void RecursiveNewtonEuler<T>(const KinematicTree&, const Vector3d&, const Wrench<T>*, \
                                        TreeWorkspace<T>*);                                      \
  template void GeneralisedForces<T>(const KinematicTree&, const TreeWorkspace<T>&, T*);
VMECH_INSTANTIATE(double)
VMECH_INSTANTIATE(Packet)
#undef VMECH_INSTANTIATE
// NOLINTEND(bugprone-macro-parentheses)

}  // namespace vmech
