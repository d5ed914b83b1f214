#include "vmech/kinematics/follow_hand.h"

#include <Eigen/Geometry>
#include <cmath>

#include "vmech/kinematics/forward_kinematics.h"
#include "vmech/kinematics/jacobian.h"
#include "vmech/kinematics/linear_algebra.h"
#include "vmech/kinematics/loops.h"

namespace vmech {

Vector6d HandError(const Posed& X_WG, const Posed& X_WH) {
  const Eigen::AngleAxisd turn(Matrix3d(X_WH.R * X_WG.R.transpose()));
  Vector6d e1;
  e1 << X_WH.p - X_WG.p, turn.angle() * turn.axis();
  return e1;
}

FollowSummary FollowHand(const KinematicTree& tree, const HandTarget& target,
                         const FollowOptions& options, DependentSolver<double>* dependents,
                         TreeWorkspace<double>* ws, VectorXd* q) {
  constexpr double kLongestStep = 0.5;  // [rad], or metres: keeps the linearisation honest
  constexpr int kClosingSteps = 3;
  FollowSummary summary;
  MatrixXd J(6, tree.nv);
  const double scale =
      options.penalty * target.stiffness.head<3>().mean() * tree.length * tree.length;
  const VectorXd weight = scale * LoopRowScale(tree).cwiseAbs2();
  VectorXd shift = VectorXd::Zero(tree.rows);
  EvaluatePose(tree, *q, ws);
  double step = 1;
  while (summary.iterations < options.max_iterations && !(step <= options.tolerance)) {
    ++summary.iterations;
    const Posed X_WG = PoseInWorld(*ws, target.node, target.X_BG);
    PointJacobian(tree, *ws, target.node, X_WG.p, &J);
    const MatrixXd C = DenseLoopJacobian(tree, *ws);
    const MatrixXd KJ = target.stiffness.asDiagonal() * J;
    const MatrixXd WC = weight.asDiagonal() * C;
    // [J; lambda C] dq = [e1; lambda (e2 + s)] in the metric K, paper eq. (8).
    const MatrixXd H = J.transpose() * KJ + C.transpose() * WC;
    VectorXd dq =
        Eigen::LDLT<MatrixXd>(H).solve(KJ.transpose() * HandError(X_WG, target.X_WH) +
                                       WC.transpose() * (StackedLoopErrors(tree, *ws) + shift));
    const double size = dq.cwiseAbs().maxCoeff();
    if (size > kLongestStep) dq *= kLongestStep / size;
    Integrate(tree, dq, q);
    EvaluatePose(tree, *q, ws);
    shift += StackedLoopErrors(tree, *ws);
    step = size;
  }
  summary.closure =
      CloseByNewton(tree, options.tolerance, kClosingSteps, dependents, ws, q->data());
  summary.converged = step <= options.tolerance && summary.closure <= options.tolerance;
  summary.hand_distance = (target.X_WH.p - PoseInWorld(*ws, target.node, target.X_BG).p).norm();
  return summary;
}

}  // namespace vmech
