#include "vmech/dynamics/loads/pose/idle_freedoms.h"

#include <Eigen/Geometry>
#include <algorithm>

#include "vmech/base/dual.h"
#include "vmech/base/linear_algebra/linear_algebra.h"
#include "vmech/base/screw_algebra.h"
#include "vmech/dynamics/loads/pose/hand_wrench.h"
#include "vmech/dynamics/rigid_body/newton_euler.h"
#include "vmech/kinematics/tree/forward_kinematics.h"

namespace vmech {
namespace {

/// Momentum of all links in the velocities v along each idle motion: N_i' M v. Uses V and F of the
/// nodes as scratch.
template <typename T>
VectorX<T> IdleMomentum(const LoadModel& model, const VectorX<T>& v, LoadWorkspace<T>* ws) {
  VectorX<T> momentum = VectorX<T>::Zero(model.tree.nv);
  Momenta(model.tree, ws->inertias, v.data(), &ws->tree, momentum.data());
  return ws->idle_motions.transpose() * momentum;
}

template <typename T>
MatrixX<T> IdleInertia(const LoadModel& model, LoadWorkspace<T>* ws) {
  MatrixX<T> inertia(model.idle, model.idle);
  for (Eigen::Index k = 0; k < model.idle; ++k) {
    inertia.col(k) = IdleMomentum<T>(model, ws->idle_motions.col(k), ws);
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
      const TreeWorkspace<double>::Node& s = ws->nodes[i + 1];
      const Matrix3d R = RotationOf(s.X);
      const Vector3d v_cm = Vector3Of(VelocityAt(PointInWorld(s.X, node.p_BoBcm), s.V));
      const Vector3d w = Vector3Of(s.V.angular);
      motion[i].col(k) << v_cm, w;
      momentum[i].col(k) << node.mass * v_cm, R * (node.I_Bcm * (R.transpose() * w));
    }
  }
  for (size_t i = 0; i < motion.size(); ++i) {
    const Posed X_WB = PoseOf(ws->nodes[i + 1].X);
    const Eigen::AngleAxisd turn(Matrix3d(X_WB.R * before[i].R.transpose()));
    Vector6d d;
    d << X_WB * model.tree.nodes[i].p_BoBcm - before[i].p, turn.angle() * turn.axis();
    f += momentum[i].transpose() * d;
    H += momentum[i].transpose() * motion[i];
  }
  return SolveAboveFloor(H, f, model.no_inertia);
}

/// The motions N among which the hand cannot tell, as combinations of the columns.
MatrixXd UnseenByHand(const LoadModel& model, const TreeWorkspace<double>& ws, const MatrixXd& N) {
  const MatrixXd seen = WeightedGraspMotions(model, ws, N);
  return N * FindLeftSingularVectors(seen.transpose()).vectors.rightCols(model.idle);
}

template <typename T>
MatrixX<T> IdleAmong(const LoadModel& model, const TreeWorkspace<T>& ws, const MatrixX<T>& N) {
  if constexpr (std::is_same_v<T, double>) {
    if (model.hand) return UnseenByHand(model, ws, N);
  }
  return N.rightCols(model.idle);
}

/// The largest of forces, of a dual its value.
template <typename T>
double Largest(const VectorX<T>& forces) {
  double largest = 0;
  for (const T& force : forces) largest = std::max(largest, std::abs(Lane(force, 0)));
  return largest;
}

/// What loads from outside, springs and friction exert along each idle motion.
template <typename T>
VectorX<T> AlongIdle(const LoadModel& model, LoadWorkspace<T>* ws) {
  const auto solve = [&](const ScrewT<T>* applied, VectorX<T>* tau) {
    NewtonEuler<T>(model.tree, ws->inertias, applied, &ws->tree, tau->data());
  };
  VectorX<T> unloaded(model.tree.nv);
  solve(nullptr, &unloaded);
  solve(ws->applied.data(), &ws->tau);
  return ws->idle_motions.transpose() * (ws->passive + unloaded - ws->tau);
}

}  // namespace

template <typename T>
void FindMotions(const LoadModel& model, LoadWorkspace<T>* ws) {
  FreeMotions(ws->tree, &ws->dependents, &ws->motions);
  if (model.idle > 0) ws->idle_motions = IdleAmong(model, ws->tree, ws->motions);
}

template <typename T>
void RemoveIdleMomentum(const LoadModel& model, LoadWorkspace<T>* ws) {
  if (model.idle_is_held) return;
  const VectorX<T> rate =
      SolveAboveFloor(IdleInertia(model, ws), IdleMomentum(model, ws->v, ws), model.no_inertia);
  ws->v -= ws->idle_motions * rate;
}

template <typename T>
void SettleIdleFreedoms(const LoadModel& model, LoadWorkspace<T>* ws) {
  ws->along_idle = Largest<T>(AlongIdle(model, ws));
  if (model.idle_is_held) return;
  const auto open = [&]() -> VectorX<T> {
    return ws->idle_motions.transpose() * (ws->tau - ws->passive);
  };
  ws->vdot -= ws->idle_motions * SolveAboveFloor(IdleInertia(model, ws), open(), model.no_inertia);
  ForwardVelocities(model.tree, ws->v.data(), &ws->tree);
  VelocityProducts(model.tree, &ws->tree);
  GyroscopicWrenches(model.tree, ws->inertias, &ws->tree);
  ForwardAccelerations(model.tree, ws->vdot.data(), &ws->tree);
  NewtonEuler(model.tree, ws->inertias, ws->applied.data(), &ws->tree, ws->tau.data());
  ws->unresisted = Largest<T>(open());
}

void IdlePositions::Remember(const TreeWorkspace<double>& ws) {
  before_.clear();
  for (size_t i = 0; i < model_.tree.nodes.size(); ++i) {
    const Posed X_WB = PoseOf(ws.nodes[i + 1].X);
    before_.push_back({X_WB.R, X_WB * model_.tree.nodes[i].p_BoBcm});
  }
}

void IdlePositions::Settle(double tolerance, DependentSolver<double>* dependents,
                           TreeWorkspace<double>* ws, VectorXd* q) const {
  constexpr int kMaxSteps = 20, kClosingSteps = 6;
  constexpr double kSettled = 1e-14;  // [rad]
  if (model_.idle_is_held) return;
  const CoordinatePartition& partition = dependents->partition();
  MatrixXd N(model_.tree.nv,
             static_cast<Eigen::Index>(partition.driven.size() + partition.idle.size()));
  for (int step = 0; step < kMaxSteps; ++step) {
    EvaluatePose(model_.tree, *q, ws);
    dependents->Factor(*ws);
    FreeMotions(*ws, dependents, &N);
    const MatrixXd idle = IdleAmong(model_, *ws, N);
    const VectorXd shift = -IdleShares(model_, before_, idle, ws);
    MoveCoordinates(model_.tree, idle * shift, q);
    CloseByNewton(model_.tree, tolerance, kClosingSteps, dependents, ws, q->data());
    if (shift.cwiseAbs().maxCoeff() < kSettled) return;
  }
}

double ShiftOfCentres(const KinematicTree& tree, const VectorXd& v, TreeWorkspace<double>* ws) {
  ForwardVelocities(tree, v.data(), ws);
  double shift = 0;
  for (size_t i = 0; i < tree.nodes.size(); ++i) {
    if (tree.nodes[i].mass == 0) continue;
    const TreeWorkspace<double>::Node& s = ws->nodes[i + 1];
    const Double4 c = PointInWorld(s.X, tree.nodes[i].p_BoBcm);
    shift = std::max(shift, Length(VelocityAt(c, s.V)) / tree.length);
  }
  return shift;
}

// NOLINTBEGIN(bugprone-macro-parentheses): T is a type
#define VMECH_INSTANTIATE(T)                                                \
  template void FindMotions<T>(const LoadModel&, LoadWorkspace<T>*);        \
  template void RemoveIdleMomentum<T>(const LoadModel&, LoadWorkspace<T>*); \
  template void SettleIdleFreedoms<T>(const LoadModel&, LoadWorkspace<T>*);
VMECH_INSTANTIATE(double)
VMECH_INSTANTIATE(Dual)
#undef VMECH_INSTANTIATE
// NOLINTEND(bugprone-macro-parentheses)

}  // namespace vmech
