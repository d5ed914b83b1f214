#include "vmech/dynamics/idle_freedoms.h"

#include <Eigen/Geometry>
#include <algorithm>

#include "vmech/dynamics/newton_euler.h"
#include "vmech/kinematics/forward_kinematics.h"
#include "vmech/kinematics/jacobian.h"
#include "vmech/kinematics/linear_algebra.h"

namespace vmech {
namespace {

/// Momentum of all links in the velocities v, as the generalised momentum M v along each idle
/// motion: N_i' M v. Uses node velocities as scratch.
VectorXd IdleMomentum(const LoadModel& model, const VectorXd& v, LoadWorkspace<double>* ws) {
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

MatrixXd IdleInertia(const LoadModel& model, LoadWorkspace<double>* ws) {
  const auto idle = static_cast<Eigen::Index>(model.partition.idle.size());
  MatrixXd inertia(idle, idle);
  for (Eigen::Index k = 0; k < idle; ++k) {
    inertia.col(k) = IdleMomentum(model, ws->motions.rightCols(idle).col(k), ws);
  }
  return inertia;
}

/// H^-1 f, with f the links' displacement from `before` along each idle motion and H the inertia of
/// the idle motions. Uses node velocities as scratch.
VectorXd IdleShares(const LoadModel& model, const std::vector<Posed>& before, const MatrixXd& N,
                    TreeWorkspace<double>* ws) {
  MatrixXd H = MatrixXd::Zero(N.cols(), N.cols());
  VectorXd f = VectorXd::Zero(N.cols());
  std::vector<MatrixXd> momentum(model.tree.nodes.size()), motion(model.tree.nodes.size());
  for (size_t i = 0; i < motion.size(); ++i) {
    motion[i] = MatrixXd::Zero(6, N.cols());
    momentum[i] = motion[i];
  }
  for (Eigen::Index k = 0; k < N.cols(); ++k) {
    const VectorXd v = N.col(k);
    ForwardVelocities(model.tree, v.data(), ws);
    for (size_t i = 0; i < motion.size(); ++i) {
      const TreeNode& node = model.tree.nodes[i];
      const NodeState<double>& s = ws->nodes[i];
      const Vector3d v_cm = s.v + s.w.cross(s.X_WB.R * node.p_BoBcm);
      const Vector3d spin = s.X_WB.R * (node.I_Bcm * (s.X_WB.R.transpose() * s.w));
      motion[i].col(k) << v_cm, s.w;
      momentum[i].col(k) << node.mass * v_cm, spin;
    }
  }
  for (size_t i = 0; i < motion.size(); ++i) {
    const Posed& X_WB = ws->nodes[i].X_WB;
    const Eigen::AngleAxisd turn(Matrix3d(X_WB.R * before[i].R.transpose()));
    Vector6d d;
    d << X_WB * model.tree.nodes[i].p_BoBcm - before[i].p, turn.angle() * turn.axis();
    f += momentum[i].transpose() * d;
    H += momentum[i].transpose() * motion[i];
  }
  return SolveSymmetric(H, f);
}

}  // namespace

void RemoveIdleMomentum(const LoadModel& model, LoadWorkspace<double>* ws) {
  const auto idle = static_cast<Eigen::Index>(model.partition.idle.size());
  const VectorXd rate = SolveSymmetric(IdleInertia(model, ws), IdleMomentum(model, ws->v, ws));
  ws->v -= ws->motions.rightCols(idle) * rate;
}

void SettleIdleFreedoms(const LoadModel& model, LoadWorkspace<double>* ws) {
  const auto idle = static_cast<Eigen::Index>(model.partition.idle.size());
  const VectorXd open = ws->motions.rightCols(idle).transpose() * (ws->tau - ws->passive);
  ws->vdot -= ws->motions.rightCols(idle) * SolveSymmetric(IdleInertia(model, ws), open);
  ForwardVelocities(model.tree, ws->v.data(), &ws->tree);
  ForwardAccelerations<double>(model.tree, ws->v.data(), ws->vdot.data(), &ws->tree);
  RecursiveNewtonEuler<double>(model.tree, model.tree.mechanism.gravity_W, ws->applied.data(),
                               &ws->tree);
  GeneralisedForces(model.tree, ws->tree, ws->tau.data());
}

void IdlePositions::Remember(const TreeWorkspace<double>& ws) {
  before_.clear();
  for (size_t i = 0; i < ws.nodes.size(); ++i) {
    const Posed& X_WB = ws.nodes[i].X_WB;
    before_.push_back({X_WB.R, X_WB * model_.tree.nodes[i].p_BoBcm});
  }
}

void IdlePositions::Settle(double tolerance, DependentSolver<double>* dependents,
                           TreeWorkspace<double>* ws, VectorXd* q) const {
  constexpr int kMaxSteps = 20, kClosingSteps = 6;
  constexpr double kSettled = 1e-14;  // [rad]
  const auto idle = static_cast<Eigen::Index>(model_.partition.idle.size());
  MatrixXd N(model_.tree.nv, static_cast<Eigen::Index>(model_.partition.driven.size()) + idle);
  for (int step = 0; step < kMaxSteps; ++step) {
    EvaluatePose(model_.tree, *q, ws);
    dependents->Factor(*ws);
    FreeMotions(*ws, dependents, &N);
    const VectorXd shift = -IdleShares(model_, before_, N.rightCols(idle), ws);
    Integrate(model_.tree, N.rightCols(idle) * shift, q);
    CloseByNewton(model_.tree, tolerance, kClosingSteps, dependents, ws, q->data());
    if (shift.cwiseAbs().maxCoeff() < kSettled) return;
  }
}

double IdleShift(const LoadModel& model, const LoadWorkspace<double>& ws, int k) {
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
