#include "vmech/kinematics/inverse/configuration_distance.h"
#include "vmech/kinematics/loops/dimensionless_loops.h"

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

namespace vmech {
namespace {

double AngleTo(const TreeNode& node, const VectorXd& a, const VectorXd& b) {
  return std::remainder(b[node.q] - a[node.q], 2 * std::numbers::pi);
}

/// Rotation vector from one unit quaternion to another, in the axes of the first.
Vector3d Turn(const TreeNode& node, const VectorXd& a, const VectorXd& b) {
  const auto quaternion = [&](const VectorXd& q) {
    return Eigen::Quaterniond(q[node.q], q[node.q + 1], q[node.q + 2], q[node.q + 3]);
  };
  Eigen::Quaterniond turn = quaternion(a).conjugate() * quaternion(b);
  if (turn.w() < 0) turn.coeffs() *= -1;
  // angle / sin(angle / 2) is 2 at 0, and the arc tangent is exact there.
  const double half_sine = turn.vec().norm();
  const double angle = 2 * std::atan2(half_sine, turn.w());
  return half_sine > 0 ? Vector3d(angle / half_sine * turn.vec()) : Vector3d::Zero();
}

}  // namespace

void CoordinateDifference(const KinematicTree& tree, const VectorXd& a, const VectorXd& b,
                          VectorXd* difference) noexcept {
  for (const TreeNode& node : tree.nodes) {
    switch (node.motion) {
      case NodeMotion::kFixed:
        break;
      case NodeMotion::kSpherical:
        difference->segment<3>(node.v) = Turn(node, a, b);
        break;
      case NodeMotion::kPrismatic:
      case NodeMotion::kScrew:
        (*difference)[node.v] = b[node.q] - a[node.q];
        break;
      case NodeMotion::kRevolute:
        (*difference)[node.v] = AngleTo(node, a, b);
        break;
    }
  }
}

VectorXd ConfigurationDifference(const KinematicTree& tree, const VectorXd& a, const VectorXd& b) {
  VectorXd difference = VectorXd::Zero(tree.nv);
  CoordinateDifference(tree, a, b, &difference);
  return difference.cwiseQuotient(VelocityScale(tree));
}

double ConfigurationDistance(const KinematicTree& tree, const VectorXd& a, const VectorXd& b) {
  return ConfigurationDifference(tree, a, b).norm();
}

}  // namespace vmech
