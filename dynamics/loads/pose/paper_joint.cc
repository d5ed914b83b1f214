#include "vmech/dynamics/loads/pose/paper_joint.h"

#include "vmech/base/linear_algebra/linear_algebra.h"
#include "vmech/dynamics/loads/pose/hand_wrench.h"
#include "vmech/kinematics/loops/loops.h"
#include "vmech/kinematics/tree/jacobian.h"

namespace vmech {
namespace {

/// The same tree with every cut joint held in all six directions (paper eq. 4-6).
KinematicTree CutThroughLinks(KinematicTree tree) {
  tree.rows = 0;
  for (Loop& loop : tree.loops) {
    loop.type = JointType::kWeld;
    loop.row = tree.rows;
    loop.rows = 6;
    tree.rows += 6;
  }
  return tree;
}

/// Rows of the drives: the grasp's Jacobian, or one unit row for each motor.
MatrixXd DriveRows(const LoadModel& model, const LoadWorkspace<double>& ws) {
  if (model.hand) {
    Matrix6Xd J(6, model.tree.nv);
    PointJacobian(model.tree, ws.tree, GraspNode(model), GraspPose(model, ws.tree).p, &J);
    const bool point = model.tree.mechanism.grasps[model.hand->grasp].kind == GraspKind::kPoint;
    return point ? MatrixXd(J.topRows(3)) : MatrixXd(J);
  }
  MatrixXd E = MatrixXd::Zero(static_cast<Eigen::Index>(model.drives.size()), model.tree.nv);
  for (size_t k = 0; k < model.drives.size(); ++k) {
    E(static_cast<Eigen::Index>(k), model.partition.driven[k]) = 1;
  }
  return E;
}

}  // namespace

VectorXd MinimumNormWrenches(const MatrixXd& J, const MatrixXd& C, const VectorXd& tau) {
  MatrixXd A(tau.size(), J.rows() + C.rows());
  A << J.transpose(), C.transpose();
  return MinimumNormSolution(A, tau);
}

void SolvePaperJoint(const LoadModel& model, LoadWorkspace<double>* ws) {
  const KinematicTree through = CutThroughLinks(model.tree);
  TreeWorkspace<double> full(through);
  full.nodes = ws->tree.nodes;
  LoopErrors(through, &full);
  LoopJacobian(through, &full);
  const MatrixXd J = DriveRows(model, *ws);
  const VectorXd x =
      MinimumNormWrenches(J, DenseLoopJacobian(through, full), ws->tau - ws->passive);
  if (model.hand) {
    ws->hand = {};
    ws->hand.force = x.head<3>();
    if (J.rows() == 6) ws->hand.moment = x.segment<3>(3);
    const Vector3d p_WG = GraspPose(model, ws->tree).p;
    for (int n = GraspNode(model); n >= 0; n = model.tree.nodes[n].parent) {
      full.nodes[n].F_Bo -= ws->hand.ShiftedBy(p_WG - full.nodes[n].X_WB.p);
    }
  }
  const VectorXd w_cut = x.tail(through.rows);
  AddMultiplierWrenches(through, w_cut.data(), &full);
  ws->tree.nodes = full.nodes;
  TreeJointWrenches(model.tree, ws->tree, &ws->joints);
  for (const Loop& loop : through.loops) {
    const Matrix3d& R_WF = ws->joints[loop.joint].R_WF;
    const Wrenchd cut{w_cut.segment<3>(loop.row), w_cut.segment<3>(loop.row + 3)};
    const Wrenchd& passive = ws->cut_passive[static_cast<size_t>(&loop - through.loops.data())];
    ws->joints[loop.joint].W_M = {R_WF * (cut.force + passive.force),
                                  R_WF * (cut.moment + passive.moment)};
  }
}

}  // namespace vmech
