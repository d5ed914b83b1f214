#include "vmech/dynamics/coupled_dynamics.h"

#include <algorithm>
#include <cmath>

#include "vmech/dynamics/newton_euler.h"
#include "vmech/kinematics/forward_kinematics.h"
#include "vmech/kinematics/loops.h"
#include "vmech/kinematics/rotation_error.h"
#include "vmech/solvers/stopping_rule.h"

namespace vmech {
namespace {

/// W C'C against the rest of H: large enough for three solves to leave 1e-9.
constexpr double kLoopWeight = 1e5;
constexpr int kSolves = 3;
/// Of the largest diagonal of H: holds a freedom without inertia.
constexpr double kDamping = 1e-14;
/// A limit's stiffness over what it has to hold.
constexpr double kHardLimit = 1e4;
constexpr int kContactChanges = 3;
constexpr int kClosingSteps = 5;
constexpr double kClosed = 1e-12;      // [-] where the closing stops
constexpr double kStillClosed = 1e-9;  // [-] beyond, a step is not taken
constexpr double kNoLimit = std::numeric_limits<double>::infinity();
constexpr double kFarthest = 0.1;  // [rad] or [m] that a coordinate moves in a step

HandCoupling Checked(HandCoupling coupling, GraspKind kind) {
  for (int i = 0; i < 6; ++i) {
    CheckRange("HandCoupling", "stiffness", coupling.stiffness[i], 0, 1e9);
    CheckRange("HandCoupling", "damping", coupling.damping[i], 0, 1e7);
  }
  CheckRange("HandCoupling", "max_force", coupling.max_force, 1e-9, kNoLimit);
  CheckRange("HandCoupling", "max_moment", coupling.max_moment, 1e-9, kNoLimit);
  if (kind == GraspKind::kPoint) {
    coupling.stiffness.tail<3>().setZero();
    coupling.damping.tail<3>().setZero();
  }
  return coupling;
}

/// Of a spring along `way` that pulls with `pull`, and with no more than `most`.
double SpringEnergy(const Vector3d& way, const Vector3d& pull, double most) {
  const double force = pull.norm();
  const double whole = 0.5 * way.dot(pull);
  if (force <= most) return whole;
  const double part = most / force;  // of the way, until it slips
  return whole * part * (2 - part);
}

bool MovesAlone(const TreeNode& node) {
  return node.v >= 0 && node.motion != NodeMotion::kSpherical;
}

}  // namespace

CoupledDynamics::CoupledDynamics(const KinematicTree& tree, const GraspFrame& grasp,
                                 const HandCoupling& coupling, double step, const VectorXd& q)
    : tree_(tree),
      coupling_(Checked(coupling, grasp.kind)),
      T_(step),
      pose_(tree, grasp),
      row_scale_(LoopRowScale(tree)),
      W_(VectorXd::Zero(tree.rows)),
      M_(MatrixXd::Zero(tree.nv, tree.nv)),
      KJ_(pose_.J()),
      WC_(pose_.C()),
      H_(M_),
      H0_(M_),
      factor_(tree.nv),
      bodies_(tree.nodes.size()),
      q_(q),
      v_(VectorXd::Zero(tree.nv)),
      next_q_(q),
      next_v_(v_),
      vdot_(v_),
      bias_(v_),
      rhs_(v_),
      x_(v_),
      mu_(W_),
      d_(W_),
      e2_(W_),
      applied_(tree.nodes.size()),
      joints_(tree.mechanism.joints.size()),
      contact_(tree.nv, 0) {
  CheckRange("CoupledDynamics", "step", step, 1e-7, 1);
  RefuseUnrenderedFriction(tree);
  pose_.Set(q);
  X_WH_ = pose_.X_WG();
  BiasForces();
  BuildSystem();
  AddCoupling();
  const double rows = (row_scale_.asDiagonal() * pose_.C()).squaredNorm();
  if (rows > 0) W_ = kLoopWeight * H0_.trace() / rows * row_scale_.cwiseAbs2();
}

void CoupledDynamics::Stop() noexcept {
  v_.setZero();
  lost_ = 0;
  ForwardVelocities(tree_, v_.data(), &pose_.ws());
}

void CoupledDynamics::TakeHold(const GraspFrame& grasp) noexcept {
  pose_.SetGrasp(grasp);
  pose_.Set(q_);
  ForwardVelocities(tree_, v_.data(), &pose_.ws());
  coupled_ = true;
}

CoupledStatus CoupledDynamics::Step(const Posed& X_WH, const Vector6d& V_WH) noexcept {
  X_WH_ = X_WH;
  V_WH_ = V_WH;
  e1_ = HandError(pose_.X_WG(), X_WH);
  const double before = Energy();
  BiasForces();
  BuildSystem();
  if (coupled_) AddCoupling();
  if (!SolveWithLimits()) return CoupledStatus::kFailed;
  if (Slip()) {
    BuildSystem();
    rhs_.noalias() += pose_.J().transpose() * w_;
    if (!SolveWithLimits()) return CoupledStatus::kFailed;
  }
  FindWrenches();
  const CoupledStatus status = Move();
  if (status == CoupledStatus::kMoved) KeepEnergy(before);
  return status;
}

/// h(q, v), and -T C' v, of which the next velocities must make up for.
void CoupledDynamics::BiasForces() noexcept {
  TreeWorkspace<double>& ws = pose_.ws();
  ForwardVelocities(tree_, v_.data(), &ws);
  ForwardAccelerations<double>(tree_, v_.data(), nullptr, &ws);
  LoopAccelerationBias(tree_, &ws);
  for (size_t l = 0; l < tree_.loops.size(); ++l) {
    const Loop& loop = tree_.loops[l];
    d_.segment(loop.row, loop.rows) = -T_ * ws.loops[l].bias.head(loop.rows);
  }
  RecursiveNewtonEuler<double>(tree_, tree_.mechanism.gravity_W, applied_.data(), &ws);
  GeneralisedForces(tree_, ws, bias_.data());
}

/// H0 v+ = rhs but for coupling, loops and limits.
void CoupledDynamics::BuildSystem() noexcept {
  CompositeMassMatrix(tree_, pose_.ws(), &bodies_, &M_);
  H0_ = M_ / T_;
  H0_.diagonal().array() += kDamping * H0_.diagonal().maxCoeff();
  rhs_ = -bias_;
  x_ = v_ / T_;
  rhs_.noalias() += M_ * x_;
  AddPassive();
}

void CoupledDynamics::AddCoupling() noexcept {
  const Vector6d gain = coupling_.damping + T_ * coupling_.stiffness;
  const Vector6d pull =
      coupling_.stiffness.cwiseProduct(e1_) + coupling_.damping.cwiseProduct(V_WH_);
  KJ_ = gain.asDiagonal() * pose_.J();
  H0_.noalias() += pose_.J().transpose() * KJ_;
  rhs_.noalias() += pose_.J().transpose() * pull;
}

/// The coupling's wrench at the end of the step. True if it is larger than it may be; then w_ is
/// shortened to that.
bool CoupledDynamics::Slip() noexcept {
  if (!coupled_) {
    w_.setZero();
    return slipping_ = false;
  }
  const Vector6d V_WG = pose_.J() * next_v_;
  w_ = coupling_.stiffness.cwiseProduct(e1_ - T_ * V_WG) +
       coupling_.damping.cwiseProduct(V_WH_ - V_WG);
  const double force = w_.head<3>().norm(), moment = w_.tail<3>().norm();
  slipping_ = force > coupling_.max_force || moment > coupling_.max_moment;
  if (force > coupling_.max_force) w_.head<3>() *= coupling_.max_force / force;
  if (moment > coupling_.max_moment) w_.tail<3>() *= coupling_.max_moment / moment;
  return slipping_;
}

/// Velocities with the joints' limits.
bool CoupledDynamics::SolveWithLimits() noexcept {
  std::fill(contact_.begin(), contact_.end(), 0);
  for (int i = 0; i < kContactChanges; ++i) {
    if (!SolveVelocity()) return false;
    if (!ChangeContacts()) break;
  }
  return true;
}

/// Springs and friction of the tree's joints; dry friction as the damper that it is at this speed.
void CoupledDynamics::AddPassive() noexcept {
  for (const TreeNode& node : tree_.nodes) {
    if (!MovesAlone(node)) continue;
    const Passive& passive = tree_.mechanism.joints[node.joint].passive[node.freedom];
    const double dry = passive.coulomb / std::max(std::abs(v_[node.v]), kSlowSliding);
    H0_(node.v, node.v) += T_ * passive.stiffness + passive.viscous + dry;
    rhs_[node.v] -= passive.stiffness * (q_[node.q] - passive.rest);
  }
}

/// (H0 + limits + C'WC) v+ = rhs + C'(W d - mu), mu += W (C v+ - d).
bool CoupledDynamics::SolveVelocity() noexcept {
  const MatrixXd& C = pose_.C();
  H_ = H0_;
  vdot_ = rhs_;
  for (const TreeNode& node : tree_.nodes) {
    if (!MovesAlone(node) || contact_[node.v] == 0) continue;
    const Joint& joint = tree_.mechanism.joints[node.joint];
    const double limit =
        contact_[node.v] > 0 ? joint.upper[node.freedom] : joint.lower[node.freedom];
    const double hold = kHardLimit * H0_(node.v, node.v);
    H_(node.v, node.v) += hold;
    vdot_[node.v] += hold * (limit - q_[node.q]) / T_;
  }
  WC_ = W_.asDiagonal() * C;
  H_.noalias() += C.transpose() * WC_;
  factor_.compute(H_);
  if (factor_.info() != Eigen::Success) return false;
  vdot_.noalias() += WC_.transpose() * d_;
  mu_.setZero();
  for (int i = 0; i < kSolves; ++i) {
    next_v_ = vdot_;
    next_v_.noalias() -= C.transpose() * mu_;
    factor_.solveInPlace(next_v_);
    e2_.noalias() = C * next_v_;
    mu_ += W_.cwiseProduct(e2_ - d_);
  }
  return next_v_.allFinite();
}

/// Limits that the step would pass begin to hold, limits that would pull let go. True if any did.
bool CoupledDynamics::ChangeContacts() noexcept {
  bool changed = false;
  for (const TreeNode& node : tree_.nodes) {
    if (!MovesAlone(node)) continue;
    const Joint& joint = tree_.mechanism.joints[node.joint];
    int& contact = contact_[node.v];
    const double end = q_[node.q] + T_ * next_v_[node.v];
    const double above = end - joint.upper[node.freedom];
    const double below = joint.lower[node.freedom] - end;
    // A limit that holds is passed a little: it pulls where it is not.
    if (contact != 0) {
      if ((contact > 0 ? above : below) < 0) {
        contact = 0;
        changed = true;
      }
    } else if (above > 0 || below > 0) {
      contact = above > 0 ? 1 : -1;
      changed = true;
    }
  }
  return changed;
}

bool CoupledDynamics::at_limit() const noexcept {
  return std::any_of(contact_.begin(), contact_.end(), [](int side) { return side != 0; });
}

/// The joints' wrenches, with the accelerations of the step.
void CoupledDynamics::FindWrenches() noexcept {
  TreeWorkspace<double>& ws = pose_.ws();
  vdot_ = (next_v_ - v_) / T_;
  ForwardAccelerations<double>(tree_, v_.data(), vdot_.data(), &ws);
  RecursiveNewtonEuler<double>(tree_, tree_.mechanism.gravity_W, applied_.data(), &ws);
  mu_ = -mu_;
  pose_.LoadJoints(w_, mu_, &joints_);
}

CoupledStatus CoupledDynamics::Move() noexcept {
  const double farthest = T_ * next_v_.lpNorm<Eigen::Infinity>();
  if (farthest > kFarthest) next_v_ *= kFarthest / farthest;
  x_ = T_ * next_v_;
  next_q_ = q_;
  MoveCoordinates(tree_, x_.data(), next_q_.data());
  const bool closed = Close();
  if (closed) {
    q_ = next_q_;
    v_ = next_v_;
  } else {
    v_.setZero();
  }
  pose_.Set(q_);
  ForwardVelocities(tree_, v_.data(), &pose_.ws());
  if (!w_.allFinite()) return CoupledStatus::kFailed;
  return closed ? CoupledStatus::kMoved : CoupledStatus::kStopped;
}

/// Chord steps H dq = C'W e2 from where the step leads.
bool CoupledDynamics::Close() noexcept {
  for (int i = 0;; ++i) {
    pose_.SetLoops(next_q_);
    for (size_t l = 0; l < tree_.loops.size(); ++l) {
      const Loop& loop = tree_.loops[l];
      e2_.segment(loop.row, loop.rows) = pose_.ws().loops[l].e2.head(loop.rows);
    }
    closure_ = 0;
    for (int r = 0; r < tree_.rows; ++r) {
      closure_ = std::max(closure_, std::abs(row_scale_[r] * e2_[r]));
    }
    if (i == kClosingSteps || closure_ <= kClosed || !std::isfinite(closure_)) break;
    x_.noalias() = WC_.transpose() * e2_;
    factor_.solveInPlace(x_);
    MoveCoordinates(tree_, x_.data(), next_q_.data());
  }
  return closure_ <= kStillClosed;
}

/// What the step has gained beyond the damper's work at most gives back what steps have lost; the
/// rest is taken out of the velocities.
void CoupledDynamics::KeepEnergy(double before) noexcept {
  constexpr double kMemory = 0.05;  // of the kinetic energy that losses are remembered for
  const Vector6d V = V_WG();
  const double dragged = T_ * coupling_.damping.cwiseProduct(V_WH_ - V).dot(V);
  const double kinetic = pose_.KineticEnergy();
  const double gained =
      kinetic + PotentialEnergy() - before - (coupled_ ? std::max(0.0, dragged) : 0);
  lost_ = std::min(lost_ - gained, kMemory * kinetic);
  if (lost_ >= 0 || kinetic == 0) return;
  v_ *= std::sqrt(std::max(0.0, 1 + lost_ / kinetic));
  lost_ = 0;
  ForwardVelocities(tree_, v_.data(), &pose_.ws());
}

double CoupledDynamics::Energy() const noexcept {
  return pose_.KineticEnergy() + PotentialEnergy();
}

double CoupledDynamics::PotentialEnergy() const noexcept {
  double energy = pose_.WeightEnergy();
  if (coupled_) {
    const Vector6d e1 = HandError(pose_.X_WG(), X_WH_);
    const Vector6d pull = coupling_.stiffness.cwiseProduct(e1);
    energy += SpringEnergy(e1.head<3>(), pull.head<3>(), coupling_.max_force) +
              SpringEnergy(e1.tail<3>(), pull.tail<3>(), coupling_.max_moment);
  }
  for (const TreeNode& node : tree_.nodes) {
    if (!MovesAlone(node)) continue;
    const Passive& passive = tree_.mechanism.joints[node.joint].passive[node.freedom];
    const double length = q_[node.q] - passive.rest;
    energy += 0.5 * passive.stiffness * length * length;
  }
  return energy;
}

}  // namespace vmech
