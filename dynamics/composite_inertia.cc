#include "vmech/dynamics/composite_inertia.h"

#include <algorithm>

#include "vmech/kinematics/forward_kinematics.h"

namespace vmech {
namespace {

void SetBody(const TreeNode& node, const Posed& X_WB, CompositeInertia* body) {
  if (node.link < 0) {
    *body = {};
    return;
  }
  const Vector3d c = X_WB * node.p_BoBcm, mc = node.mass * c;
  const Matrix3d RI = X_WB.R * node.I_Bcm;
  body->mass = node.mass;
  body->moment = mc;
  const double square = c.dot(mc);
  for (int j = 0; j < 3; ++j) {
    for (int i = j; i < 3; ++i) {
      const double moment = RI.row(i).dot(X_WB.R.row(j)) - c[i] * mc[j] + (i == j ? square : 0);
      body->I_Wo(i, j) = body->I_Wo(j, i) = moment;
    }
  }
}

int Freedoms(const TreeNode& node) {
  if (node.v < 0) return 0;
  return node.motion == NodeMotion::kSpherical ? 3 : 1;
}

/// [linear; angular] about the origin of W.
Vector6d Momentum(const CompositeInertia& body, const Vector6d& twist) {
  const Vector3d v = twist.head<3>(), w = twist.tail<3>();
  return Stacked<double>(body.mass * v + w.cross(body.moment),
                         body.I_Wo * w + body.moment.cross(v));
}

}  // namespace

void CompositeMassMatrix(const KinematicTree& tree, const TreeWorkspace<double>& ws,
                         MassMatrixMemory* memory, MatrixXd* M) {
  std::fill_n(M->data(), M->size(), 0.0);
  const Vector3d Wo = Vector3d::Zero();
  const int count = static_cast<int>(tree.nodes.size());
  for (int i = 0; i < count; ++i) {
    const TreeNode& node = tree.nodes[i];
    SetBody(node, ws.nodes[i].X_WB, &memory->bodies[i]);
    for (int axis = 0; axis < Freedoms(node); ++axis) {
      memory->twists[node.v + axis] = UnitTwistAt(tree, ws, i, axis, Wo);
    }
  }
  for (int i = count; i-- > 0;) {
    const TreeNode& node = tree.nodes[i];
    const CompositeInertia& body = memory->bodies[i];
    for (int v = node.v; v < node.v + Freedoms(node); ++v) {
      // Row and column v: the momentum of what moves with v, along every joint below.
      const Vector6d momentum = Momentum(body, memory->twists[v]);
      for (int j = i; j >= 0; j = tree.nodes[j].parent) {
        const TreeNode& below = tree.nodes[j];
        for (int u = below.v; u < below.v + Freedoms(below); ++u) {
          (*M)(u, v) = (*M)(v, u) = memory->twists[u].dot(momentum);
        }
      }
    }
    if (node.parent < 0) continue;
    CompositeInertia& carrier = memory->bodies[node.parent];
    carrier.mass += body.mass;
    carrier.moment += body.moment;
    carrier.I_Wo += body.I_Wo;
  }
}

}  // namespace vmech
