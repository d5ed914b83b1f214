#include "vmech/dynamics/loads/pose/hand_wrench.h"

#include <algorithm>
#include <cmath>

#include "vmech/base/linear_algebra/linear_algebra.h"
#include "vmech/base/screw_algebra.h"
#include "vmech/dynamics/rigid_body/newton_euler.h"
#include "vmech/kinematics/tree/forward_kinematics.h"

namespace vmech {
namespace {

/// Of motions that the hand sees, against the largest: what is less is not seen.
constexpr double kUnseen = 1e-9;

/// The shortest s of the least squares (J N) s = V in the metric K: without what the hand does not
/// see.
VectorXd NearestMotion(const LoadModel& model, const LoadWorkspace<double>& ws, const Vector6d& V) {
  const MatrixXd A = WeightedGraspMotions(model, ws.tree, ws.motions);
  const double largest = A.colwise().norm().maxCoeff();
  return MinimumNormSolution(A, model.hand_stiffness.cwiseSqrt().cwiseProduct(V),
                             kUnseen * std::min(1.0, largest));
}

}  // namespace

GraspFrame HandGrasp(const LoadModel& model) {
  return GraspFrameOf(model.tree, model.hand->grasp);
}

MatrixXd WeightedGraspMotions(const LoadModel& model, const TreeWorkspace<double>& ws,
                              const MatrixXd& N) {
  const GraspFrame grasp = HandGrasp(model);
  Matrix6Xd J(6, model.tree.nv);
  GraspJacobian(model.tree, ws, grasp.node, grasp.X_BG, &J);
  return model.hand_stiffness.cwiseSqrt().asDiagonal() * J * N;
}

Posed GraspPose(const LoadModel& model, const TreeWorkspace<double>& ws) {
  const GraspFrame grasp = HandGrasp(model);
  return PoseInWorld(ws, grasp.node, grasp.X_BG);
}

void HandVelocities(const LoadModel& model, const HandSample& hand, LoadWorkspace<double>* ws) {
  ws->v = ws->motions * NearestMotion(model, *ws, hand.V_WH);
}

void HandAccelerations(const LoadModel& model, const HandSample& hand, LoadWorkspace<double>* ws) {
  const GraspFrame grasp = HandGrasp(model);
  const Vector6d A_WG = GraspAcceleration(ws->tree, grasp.node, grasp.X_BG);
  ws->vdot += ws->motions * NearestMotion(model, *ws, hand.A_WH - A_WG);
}

void ApplyHandWrench(const LoadModel& model, LoadWorkspace<double>* ws) {
  const MatrixXd A = WeightedGraspMotions(model, ws->tree, ws->motions);
  const VectorXd along = ws->motions.transpose() * (ws->tau - ws->passive);
  const double largest = A.colwise().norm().maxCoeff();
  const Vector6d w_d = model.hand_stiffness.cwiseSqrt().cwiseProduct(
      MinimumNormSolution(A.transpose(), along, kUnseen * std::min(1.0, largest)));
  ws->hand = {w_d.head<3>(), w_d.tail<3>()};
  ApplyHand(model, ws);
}

void ApplyHand(const LoadModel& model, LoadWorkspace<double>* ws) {
  const GraspFrame grasp = HandGrasp(model);
  const Double4 p = PointInWorld(ws->tree.at(grasp.node).X, grasp.X_BG.p);
  const Screw W = WrenchAt(p, Double4Of(ws->hand.force), Double4Of(ws->hand.moment));
  ApplyAlongBranch(model.tree, grasp.node, W, &ws->tree);
  GeneralisedForces(model.tree, ws->tree, ws->tau.data());
}

}  // namespace vmech
