#include "vmech/apps/assembled.h"

#include <Eigen/Geometry>
#include <stdexcept>

#include "vmech/kinematics/forward_kinematics.h"
#include "vmech/kinematics/loops.h"

namespace vmech {
namespace {

void SetTreeStarts(const KinematicTree& tree, const VectorXd& q, Mechanism* mechanism) {
  for (const TreeNode& node : tree.nodes) {
    if (node.motion == NodeMotion::kFixed) continue;
    std::vector<double>& start = mechanism->joints[node.joint].start;
    const int count = node.motion == NodeMotion::kSpherical ? 4 : 1;
    for (int i = 0; i < count; ++i) start[node.freedom + i] = q[node.q + i];
  }
}

void SetCutStarts(const KinematicTree& tree, const VectorXd& q, Mechanism* mechanism) {
  TreeWorkspace<double> ws(tree);
  ForwardKinematics(tree, q.data(), &ws);
  LoopErrors(tree, &ws);
  for (size_t l = 0; l < tree.loops.size(); ++l) {
    Joint& joint = mechanism->joints[tree.loops[l].joint];
    const Vector3d values = CutJointCoordinates(tree.loops[l], ws.loops[l]);
    if (joint.type == JointType::kSpherical) {
      const Eigen::Quaterniond turn(Eigen::AngleAxisd(values.norm(), values.stableNormalized()));
      joint.start = {turn.w(), turn.x(), turn.y(), turn.z()};
    } else {
      joint.start.assign(values.data(), values.data() + FreedomsOf(joint.type));
    }
  }
}

}  // namespace

Mechanism Assembled(const Mechanism& mechanism) {
  constexpr double kClosed = 1e-12;  // of the characteristic length and of 1 rad
  const KinematicTree tree = BuildKinematicTree(mechanism);
  VectorXd q = StartCoordinates(tree);
  const AssemblySummary summary = Assemble(tree, {}, &q);
  if (!summary.closed) throw std::runtime_error(summary.message);
  Mechanism assembled = mechanism;
  if (summary.start_error > kClosed) SetTreeStarts(tree, q, &assembled);
  SetCutStarts(tree, summary.start_error > kClosed ? q : StartCoordinates(tree), &assembled);
  return assembled;
}

}  // namespace vmech
