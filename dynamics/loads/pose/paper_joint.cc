#include "vmech/dynamics/loads/pose/paper_joint.h"

#include "vmech/base/linear_algebra/linear_algebra.h"
#include "vmech/base/screw_algebra.h"
#include "vmech/dynamics/loads/pose/hand_wrench.h"
#include "vmech/kinematics/loops/loops.h"

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
    const GraspFrame grasp = HandGrasp(model);
    Matrix6Xd J(6, model.tree.nv);
    GraspJacobian(model.tree, ws.tree, grasp.node, grasp.X_BG, &J);
    return grasp.kind == GraspKind::kPoint ? MatrixXd(J.topRows(3)) : MatrixXd(J);
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
  full.S = ws->tree.S;
  LoopErrors(through, &full);
  LoopJacobian(through, &full);
  const MatrixXd J = DriveRows(model, *ws);
  const VectorXd x =
      MinimumNormWrenches(J, DenseLoopJacobian(through, full), ws->tau - ws->passive);
  if (model.hand) {
    ws->hand = {};
    ws->hand.force = x.head<3>();
    if (J.rows() == 6) ws->hand.moment = x.segment<3>(3);
    ApplyHand(model, ws);
    full.nodes = ws->tree.nodes;
  }
  const VectorXd w_cut = x.tail(through.rows);
  ApplyMultipliers(through, w_cut.data(), &full, &ws->joints);
  ws->tree.nodes = full.nodes;
  for (size_t l = 0; l < through.loops.size(); ++l) {
    ws->joints[through.loops[l].joint].W += WrenchFrom(full.loops[l].F, ws->cut_passive[l]);
  }
}

}  // namespace vmech
