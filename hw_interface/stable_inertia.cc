#include "vmech/hw_interface/stable_inertia.h"

#include <algorithm>

#include "vmech/dynamics/newton_euler.h"
#include "vmech/kinematics/forward_kinematics.h"
#include "vmech/kinematics/jacobian.h"
#include "vmech/kinematics/linear_algebra.h"
#include "vmech/kinematics/loops.h"

namespace vmech {
namespace {

/// Basis of C v = 0 [nv, mobility].
MatrixXd AllowedMotions(const KinematicTree& tree, TreeWorkspace<double>* ws) {
  if (tree.loops.empty()) return MatrixXd::Identity(tree.nv, tree.nv);
  constexpr double kRank = 1e-9;
  LoopErrors(tree, ws);
  LoopJacobian(tree, ws);
  return FindNullSpace(LoopRowScale(tree).asDiagonal() * DenseLoopJacobian(tree, *ws), kRank).basis;
}

}  // namespace

double StableInertiaShare(const KinematicTree& tree, const GraspFrame& grasp, const VectorXd& q,
                          const DeviceInfo& device) {
  constexpr double kMargin = 0.5;
  if (device.linear.mass == 0) return 1;
  TreeWorkspace<double> ws(tree);
  ForwardKinematics(tree, q.data(), &ws);
  const MatrixXd N = AllowedMotions(tree, &ws);
  MatrixXd J(6, tree.nv);
  PointJacobian(tree, ws, grasp.node, PoseInWorld(ws, grasp.node, grasp.X_BG).p, &J);
  const double turning = grasp.kind == GraspKind::kRigid ? device.angular.mass : 0;
  Vector6d D;
  D << Vector3d::Constant(device.linear.mass), Vector3d::Constant(turning);
  const MatrixXd JN = J * N;
  const MatrixXd handle = JN.transpose() * D.asDiagonal() * JN;
  const MatrixXd mechanism = N.transpose() * MassMatrix(tree, q) * N;
  // lambda of the symmetric L^-1 M L^-T, handle = L L'.
  const Eigen::LLT<MatrixXd> factor(handle);
  if (factor.info() != Eigen::Success) return 1;
  const MatrixXd half = factor.matrixL().solve(mechanism);
  const MatrixXd ratio = factor.matrixL().solve(half.transpose());
  const double lambda = FindLeftSingularVectors(ratio).values.maxCoeff();
  return lambda > 0 ? std::min(1.0, kMargin / lambda) : 1;
}

}  // namespace vmech
