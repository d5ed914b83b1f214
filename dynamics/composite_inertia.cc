#include "vmech/dynamics/composite_inertia.h"

#include "vmech/kinematics/forward_kinematics.h"

namespace vmech {
namespace {

/// A twist or a momentum about the origin of W.
struct Screw {
  Vector3d linear, angular;
};

CompositeInertia BodyInertia(const TreeNode& node, const Posed& X_WB) {
  if (node.link < 0) return {};
  const Vector3d c = X_WB * node.p_BoBcm;
  const Matrix3d I_cm = X_WB.R * node.I_Bcm * X_WB.R.transpose();
  const Matrix3d I_Wo =
      I_cm + node.mass * (c.squaredNorm() * Matrix3d::Identity() - c * c.transpose());
  return {node.mass, node.mass * c, I_Wo};
}

int Freedoms(const TreeNode& node) {
  if (node.v < 0) return 0;
  return node.motion == NodeMotion::kSpherical ? 3 : 1;
}

Screw UnitTwist(const KinematicTree& tree, const TreeWorkspace<double>& ws, int i, int axis) {
  const JointAxis<double> s = AxisInWorld(tree, ws, i, axis);
  return {s.linear + ws.nodes[i].X_WB.p.cross(s.angular), s.angular};
}

Screw Momentum(const CompositeInertia& body, const Screw& twist) {
  return {body.mass * twist.linear + twist.angular.cross(body.moment),
          body.I_Wo * twist.angular + body.moment.cross(twist.linear)};
}

/// Row and column `v` of M: the momentum of what moves with v, along every joint below.
void FillRow(const KinematicTree& tree, const TreeWorkspace<double>& ws, int from, int v,
             const Screw& momentum, MatrixXd* M) {
  for (int j = from; j >= 0; j = tree.nodes[j].parent) {
    const TreeNode& node = tree.nodes[j];
    for (int axis = 0; axis < Freedoms(node); ++axis) {
      const Screw s = UnitTwist(tree, ws, j, axis);
      const double m = s.linear.dot(momentum.linear) + s.angular.dot(momentum.angular);
      (*M)(v, node.v + axis) = (*M)(node.v + axis, v) = m;
    }
  }
}

}  // namespace

void CompositeMassMatrix(const KinematicTree& tree, const TreeWorkspace<double>& ws,
                         std::vector<CompositeInertia>* bodies, MatrixXd* M) {
  M->setZero();
  const int count = static_cast<int>(tree.nodes.size());
  for (int i = 0; i < count; ++i) (*bodies)[i] = BodyInertia(tree.nodes[i], ws.nodes[i].X_WB);
  for (int i = count; i-- > 0;) {
    const TreeNode& node = tree.nodes[i];
    const CompositeInertia& body = (*bodies)[i];
    for (int axis = 0; axis < Freedoms(node); ++axis) {
      const Screw momentum = Momentum(body, UnitTwist(tree, ws, i, axis));
      FillRow(tree, ws, i, node.v + axis, momentum, M);
    }
    if (node.parent < 0) continue;
    CompositeInertia& carrier = (*bodies)[node.parent];
    carrier.mass += body.mass;
    carrier.moment += body.moment;
    carrier.I_Wo += body.I_Wo;
  }
}

}  // namespace vmech
