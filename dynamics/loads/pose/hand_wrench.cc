#include "vmech/dynamics/loads/pose/hand_wrench.h"

#include <algorithm>
#include <cmath>

#include "vmech/base/linear_algebra/linear_algebra.h"
#include "vmech/dynamics/rigid_body/newton_euler.h"
#include "vmech/kinematics/tree/forward_kinematics.h"
#include "vmech/kinematics/tree/jacobian.h"

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

MatrixXd WeightedGraspMotions(const LoadModel& model, const TreeWorkspace<double>& ws,
                              const MatrixXd& N) {
  Matrix6Xd J(6, model.tree.nv);
  PointJacobian(model.tree, ws, GraspNode(model), GraspPose(model, ws).p, &J);
  return model.hand_stiffness.cwiseSqrt().asDiagonal() * J * N;
}

int GraspNode(const LoadModel& model) {
  return model.tree.NodeOfLink(model.tree.mechanism.grasps[model.hand->grasp].link);
}

Posed GraspPose(const LoadModel& model, const TreeWorkspace<double>& ws) {
  const Grasp& grasp = model.tree.mechanism.grasps[model.hand->grasp];
  return PoseInWorld(ws, GraspNode(model), model.tree.X_node_link(grasp.link) * grasp.X_LG);
}

void HandVelocities(const LoadModel& model, const HandSample& hand, LoadWorkspace<double>* ws) {
  ws->v = ws->motions * NearestMotion(model, *ws, hand.V_WH);
}

void HandAccelerations(const LoadModel& model, const HandSample& hand, LoadWorkspace<double>* ws) {
  const Vector6d A_WG = PointAcceleration(ws->tree, GraspNode(model), GraspPose(model, ws->tree).p);
  ws->vdot += ws->motions * NearestMotion(model, *ws, hand.A_WH - A_WG);
}

void ApplyHandWrench(const LoadModel& model, LoadWorkspace<double>* ws) {
  const MatrixXd A = WeightedGraspMotions(model, ws->tree, ws->motions);
  const VectorXd along = ws->motions.transpose() * (ws->tau - ws->passive);
  const double largest = A.colwise().norm().maxCoeff();
  const Vector6d w_d = model.hand_stiffness.cwiseSqrt().cwiseProduct(
      MinimumNormSolution(A.transpose(), along, kUnseen * std::min(1.0, largest)));
  ws->hand = {w_d.head<3>(), w_d.tail<3>()};
  const Vector3d p_WG = GraspPose(model, ws->tree).p;
  for (int n = GraspNode(model); n >= 0; n = model.tree.nodes[n].parent) {
    NodeState<double>& node = ws->tree.nodes[n];
    node.F_Bo -= ws->hand.ShiftedBy(p_WG - node.X_WB.p);
  }
  GeneralisedForces(model.tree, ws->tree, ws->tau.data());
}

}  // namespace vmech
