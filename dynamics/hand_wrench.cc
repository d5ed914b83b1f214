#include "vmech/dynamics/hand_wrench.h"

#include <cmath>

#include "vmech/dynamics/newton_euler.h"
#include "vmech/kinematics/forward_kinematics.h"
#include "vmech/kinematics/jacobian.h"
#include "vmech/kinematics/linear_algebra.h"

namespace vmech {
namespace {

MatrixXd GraspMotions(const LoadModel& model, const TreeWorkspace<double>& ws, const MatrixXd& N) {
  Matrix6Xd J(6, model.tree.nv);
  PointJacobian(model.tree, ws, GraspNode(model), GraspPose(model, ws).p, &J);
  return J * N;
}

/// s of the least squares (J N) s = V in the metric K.
VectorXd NearestMotion(const LoadModel& model, const LoadWorkspace<double>& ws, const Vector6d& V) {
  const MatrixXd JN = GraspMotions(model, ws.tree, ws.motions);
  const MatrixXd KJN = model.hand_stiffness.asDiagonal() * JN;
  return SolveSymmetric(JN.transpose() * KJN, KJN.transpose() * V);
}

}  // namespace

int GraspNode(const LoadModel& model) {
  return model.tree.NodeOfLink(model.tree.mechanism.grasps[model.hand->grasp].link);
}

Posed GraspPose(const LoadModel& model, const TreeWorkspace<double>& ws) {
  const Grasp& grasp = model.tree.mechanism.grasps[model.hand->grasp];
  return PoseInWorld(ws, GraspNode(model), model.tree.X_node_link(grasp.link) * grasp.X_LG);
}

double HandAuthority(const LoadModel& model, const TreeWorkspace<double>& ws, const MatrixXd& N) {
  if (N.cols() == 0) return 1;
  const MatrixXd JN = GraspMotions(model, ws, N);
  if (N.cols() > 6) return 0;
  const MatrixXd weighted = model.hand_stiffness.cwiseSqrt().asDiagonal() * JN;
  const VectorXd sigma = FindLeftSingularVectors(weighted).values;
  return sigma.minCoeff() / sigma.maxCoeff();
}

void HandVelocities(const LoadModel& model, const HandSample& hand, LoadWorkspace<double>* ws) {
  ws->v = ws->motions * NearestMotion(model, *ws, hand.V_WH);
}

void HandAccelerations(const LoadModel& model, const HandSample& hand, LoadWorkspace<double>* ws) {
  const Vector6d A_WG = PointAcceleration(ws->tree, GraspNode(model), GraspPose(model, ws->tree).p);
  ws->vdot += ws->motions * NearestMotion(model, *ws, hand.A_WH - A_WG);
}

void ApplyHandWrench(const LoadModel& model, LoadWorkspace<double>* ws) {
  const MatrixXd JN = GraspMotions(model, ws->tree, ws->motions);
  const MatrixXd KJN = model.hand_stiffness.asDiagonal() * JN;
  const VectorXd along = ws->motions.transpose() * (ws->tau - ws->passive);
  const Vector6d w_d = KJN * SolveSymmetric(JN.transpose() * KJN, along);
  ws->hand = {w_d.head<3>(), w_d.tail<3>()};
  const Vector3d p_WG = GraspPose(model, ws->tree).p;
  for (int n = GraspNode(model); n >= 0; n = model.tree.nodes[n].parent) {
    NodeState<double>& node = ws->tree.nodes[n];
    node.F_Bo -= ws->hand.ShiftedBy(p_WG - node.X_WB.p);
  }
  GeneralisedForces(model.tree, ws->tree, ws->tau.data());
}

}  // namespace vmech
