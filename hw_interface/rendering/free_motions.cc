#include "vmech/hw_interface/rendering/free_motions.h"

#include "vmech/base/linear_algebra/linear_algebra.h"
#include "vmech/kinematics/loops/dimensionless_loops.h"
#include "vmech/kinematics/loops/loops.h"

namespace vmech {

MatrixXd FreeMotions(const KinematicTree& tree, TreeWorkspace<double>* ws) {
  if (tree.loops.empty()) return MatrixXd::Identity(tree.nv, tree.nv);
  LoopErrors(tree, ws);
  LoopJacobian(tree, ws);
  return FindNullSpace(BindingRowScale(tree).asDiagonal() * DenseLoopJacobian(tree, *ws),
                       kRankTolerance)
      .basis;
}

}  // namespace vmech
