#include "vmech/dynamics/idle_freedoms.h"

#include <algorithm>

#include "vmech/dynamics/newton_euler.h"
#include "vmech/kinematics/forward_kinematics.h"
#include "vmech/kinematics/linear_algebra.h"

namespace vmech {
namespace {

/// Momentum of all links in the velocities v, as the generalised momentum M v along each idle
/// motion: N_i' M v. Uses node velocities as scratch.
VectorXd IdleMomentum(const LoadModel& model, const VectorXd& v, LoadWorkspace* ws) {
  // M v is the inverse dynamics of the accelerations v at rest without gravity.
  const std::vector<Wrenchd> nothing(model.tree.nodes.size());
  const VectorXd rest = VectorXd::Zero(model.tree.nv);
  ForwardVelocities(model.tree, rest.data(), &ws->tree);
  ForwardAccelerations<double>(model.tree, rest.data(), v.data(), &ws->tree);
  RecursiveNewtonEuler<double>(model.tree, Vector3d::Zero(), nothing.data(), &ws->tree);
  VectorXd momentum = VectorXd::Zero(model.tree.nv);
  GeneralisedForces(model.tree, ws->tree, momentum.data());
  const auto idle = static_cast<Eigen::Index>(model.partition.idle.size());
  return ws->motions.rightCols(idle).transpose() * momentum;
}

MatrixXd IdleInertia(const LoadModel& model, LoadWorkspace* ws) {
  const auto idle = static_cast<Eigen::Index>(model.partition.idle.size());
  MatrixXd inertia(idle, idle);
  for (Eigen::Index k = 0; k < idle; ++k) {
    inertia.col(k) = IdleMomentum(model, ws->motions.rightCols(idle).col(k), ws);
  }
  return inertia;
}

}  // namespace

void RemoveIdleMomentum(const LoadModel& model, LoadWorkspace* ws) {
  const auto idle = static_cast<Eigen::Index>(model.partition.idle.size());
  const VectorXd rate = SolveSymmetric(IdleInertia(model, ws), IdleMomentum(model, ws->v, ws));
  ws->v -= ws->motions.rightCols(idle) * rate;
}

void SettleIdleFreedoms(const LoadModel& model, LoadWorkspace* ws) {
  const auto idle = static_cast<Eigen::Index>(model.partition.idle.size());
  const VectorXd open = ws->motions.rightCols(idle).transpose() * (ws->tau - ws->passive);
  ws->vdot -= ws->motions.rightCols(idle) * SolveSymmetric(IdleInertia(model, ws), open);
  ForwardVelocities(model.tree, ws->v.data(), &ws->tree);
  ForwardAccelerations<double>(model.tree, ws->v.data(), ws->vdot.data(), &ws->tree);
  RecursiveNewtonEuler<double>(model.tree, model.tree.mechanism.gravity_W, ws->applied.data(),
                               &ws->tree);
  GeneralisedForces(model.tree, ws->tree, ws->tau.data());
}

double IdleShift(const LoadModel& model, const LoadWorkspace& ws, int k) {
  TreeWorkspace<double> scratch = ws.tree;
  const auto column = static_cast<Eigen::Index>(model.partition.driven.size()) + k;
  const VectorXd v = ws.motions.col(column);
  ForwardVelocities(model.tree, v.data(), &scratch);
  double shift = 0;
  for (size_t i = 0; i < model.tree.nodes.size(); ++i) {
    if (model.tree.nodes[i].mass == 0) continue;
    const NodeState<double>& s = scratch.nodes[i];
    const Vector3d c = s.X_WB.R * model.tree.nodes[i].p_BoBcm;
    shift = std::max(shift, (s.v + s.w.cross(c)).norm() / model.tree.length);
  }
  return shift;
}

}  // namespace vmech
