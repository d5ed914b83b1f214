#include "vmech/apps/drawing/view.h"

#include <Eigen/Geometry>
#include <cmath>
#include <optional>

#include "vmech/kinematics/loops/closure.h"
#include "vmech/kinematics/tree/forward_kinematics.h"
#include "vmech/kinematics/tree/tree_workspace.h"

namespace vmech {
namespace {

constexpr double kParallel = 1e-6;  // [rad]

Vector3d AxisOf(const Mechanism& mechanism, const std::vector<Posed>& X_WL, const Joint& joint) {
  const AnchorId id = joint.first;
  return X_WL[id.link].R * mechanism.anchor(id).X_LA.R.col(2);
}

bool TurnsAboutZAlone(JointType type) {
  return type == JointType::kRevolute || type == JointType::kCylindrical ||
         type == JointType::kScrew || type == JointType::kPlanar;
}

/// The direction across which everything moves, if there is one.
std::optional<Vector3d> CommonAxis(const Mechanism& mechanism, const std::vector<Posed>& X_WL) {
  std::optional<Vector3d> axis;
  for (const Joint& joint : mechanism.joints) {
    if (joint.type == JointType::kWeld || joint.type == JointType::kPrismatic) continue;
    if (!TurnsAboutZAlone(joint.type)) return {};
    const Vector3d z = AxisOf(mechanism, X_WL, joint);
    if (axis && axis->cross(z).norm() > kParallel) return {};
    if (!axis) axis = z;
  }
  for (const Joint& joint : mechanism.joints) {
    if (!axis || joint.type != JointType::kPrismatic) continue;
    if (std::abs(axis->dot(AxisOf(mechanism, X_WL, joint))) > kParallel) return {};
  }
  return axis;
}

/// The axis of the world that gravity pulls along most, away from it.
Vector3d Upwards(const Mechanism& mechanism) {
  Vector3d up = Vector3d::UnitZ();
  Eigen::Index axis = 2;
  const double pull = mechanism.gravity_W.cwiseAbs().maxCoeff(&axis);
  if (pull == 0) return up;
  up.setZero();
  up[axis] = mechanism.gravity_W[axis] > 0 ? -1 : 1;
  return up;
}

/// Looks along an axis, from the side on which the drawing's right is along an axis of the world.
View Along(Vector3d toward, Vector3d up) {
  if (toward.cross(up).norm() < 1e-3)
    up = std::abs(toward.y()) < 0.9 ? Vector3d::UnitY() : Vector3d::UnitX();
  View view;
  view.up = (up - up.dot(toward) * toward).normalized();
  view.right = view.up.cross(toward);
  Eigen::Index most = 0;
  view.right.cwiseAbs().maxCoeff(&most);
  if (view.right[most] < 0) view.right = -view.right, toward = -toward;
  view.toward = toward;
  return view;
}

}  // namespace

std::vector<Posed> LinkPoses(const KinematicTree& tree) {
  TreeWorkspace<double> ws(tree);
  EvaluatePose(tree, StartCoordinates(tree), &ws, false);
  std::vector<Posed> poses;
  for (int link = 0; link < static_cast<int>(tree.mechanism.links.size()); ++link) {
    poses.push_back(PoseInWorld(ws, tree.NodeOfLink(link), tree.X_node_link(link)));
  }
  return poses;
}

View ViewOf(const Mechanism& mechanism, const std::vector<Posed>& X_WL) {
  const Vector3d up = Upwards(mechanism);
  if (const std::optional<Vector3d> axis = CommonAxis(mechanism, X_WL)) {
    View view = Along(axis->normalized(), up);
    view.planar = true;
    return view;
  }
  const Vector3d side = up.x() == 0 ? Vector3d::UnitX() : Vector3d::UnitY();
  View view;
  view.toward = (up + side - up.cross(side)).normalized();
  view.up = (up - up.dot(view.toward) * view.toward).normalized();
  view.right = view.up.cross(view.toward);
  return view;
}

}  // namespace vmech
