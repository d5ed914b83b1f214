#include "vmech/kinematics/loops/dimensionless_loops.h"

#include "vmech/kinematics/loops/closure.h"
#include "vmech/kinematics/loops/loops.h"

namespace vmech {

VectorXd VelocityScale(const KinematicTree& tree) {
  VectorXd scale = VectorXd::Ones(tree.nv);
  for (const TreeNode& node : tree.nodes) {
    if (node.motion == NodeMotion::kPrismatic) scale[node.v] = tree.length;
  }
  return scale;
}

MatrixXd DimensionlessLoopJacobian(const KinematicTree& tree, const VectorXd& q) {
  TreeWorkspace<double> ws(tree);
  EvaluatePose(tree, q, &ws);
  return LoopRowScale(tree).asDiagonal() * DenseLoopJacobian(tree, ws) *
         VelocityScale(tree).asDiagonal();
}

}  // namespace vmech
