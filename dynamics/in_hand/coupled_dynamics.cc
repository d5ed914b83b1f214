#include "vmech/dynamics/in_hand/coupled_dynamics.h"

#include <algorithm>
#include <cmath>

#include "vmech/base/check_range.h"
#include "vmech/base/linear_algebra/linear_algebra.h"
#include "vmech/base/linear_algebra/small_ldlt.h"
#include "vmech/base/rotation_error.h"
#include "vmech/base/screw_algebra.h"
#include "vmech/dynamics/loads/pose/contact_friction.h"
#include "vmech/kinematics/loops/dimensionless_loops.h"
#include "vmech/kinematics/loops/mobility.h"
#include "vmech/kinematics/tree/forward_kinematics.h"
#include "vmech/kinematics/tree/validity.h"

namespace vmech {
namespace {

/// Of loops against the rest, see SaddleSystem.
constexpr double kLoopWeight = 1e5;
constexpr double kRegularisation = 1e-14;  // of the largest inertia
constexpr double kNoInertia = 1e-9;  // of the largest: rounding, times the weight of the loops
/// A limit's stiffness over what it has to hold.
constexpr double kHardLimit = 1e4;
constexpr int kContactChanges = 3;
constexpr int kClosingSteps = 5;
constexpr double kClosed = 3e-11;      // [-] where the closing stops
constexpr double kStillClosed = 1e-9;  // [-] beyond, a step is not taken
constexpr double kSameWay = 1e-3;      // of a velocity, across the last
constexpr double kMuchFaster = 10;     // than in the last step
constexpr double kNoLimit = std::numeric_limits<double>::infinity();
constexpr double kOpen = 1e-6;     // loops at the start; poses of files close to 1e-13
constexpr double kFarthest = 0.1;  // [rad] and [m] that the coordinates move in a step

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
double SpringEnergy(const Four& way, const Four& pull, double most) {
  const double whole = 0.5 * Dot(way, pull), force2 = Dot(pull, pull);
  if (force2 <= most * most) return whole;
  const double part = most / std::sqrt(force2);  // of the way, until it slips
  return whole * part * (2 - part);
}

/// n columns, and zeros that fill up whole registers.
MatrixXd PaddedSquare(int n) {
  return MatrixXd::Zero(n, PaddedSize(n));
}

double SquaredSpeed(const VectorXd& v) {
  return DotOfFours(v.data(), v.data(), static_cast<int>(v.size()));
}

/// Shortens a vector to `most`. True if it was longer.
bool Shorten(double most, Four* a) {
  const double length2 = Dot(*a, *a);
  if (length2 <= most * most) return false;
  *a *= most / std::sqrt(length2);
  return true;
}

}  // namespace

CoupledDynamics::Coupling::Coupling(const HandCoupling& coupling, double step)
    : stiffness(ScrewOf(coupling.stiffness)),
      damping(ScrewOf(coupling.damping)),
      root_gain(ScrewOf((coupling.damping + step * coupling.stiffness).cwiseSqrt())),
      max_force(coupling.max_force),
      max_moment(coupling.max_moment) {}

CoupledDynamics::CoupledDynamics(const KinematicTree& tree, const GraspFrame& grasp,
                                 const HandCoupling& coupling, double step, const VectorXd& q)
    : tree_(tree),
      coupling_(Checked(coupling, grasp.kind), step),
      T_(step),
      pose_(tree, grasp),
      system_(tree.nv, static_cast<int>(pose_.C().rows())),
      M_(PaddedSquare(tree.nv)),
      A_(M_),
      limited_A_(M_),
      rootKJ_(MatrixXd::Zero(PaddedSize(6), tree.nv)),
      q_(q),
      v_(VectorXd::Zero(PaddedSize(tree.nv))),
      next_q_(q),
      next_v_(v_),
      vdot_(v_),
      momenta_(v_),
      bias_(v_),
      right_(v_),
      limited_right_(v_),
      x_(v_),
      correction_(v_),
      rest_(v_),
      mu_(pose_.e2()),
      d_(mu_),
      predicted_defect_(mu_),
      last_closure_defect_(mu_),
      joints_(tree.mechanism.joints.size()) {
  CheckRange("CoupledDynamics", "step", step, 1e-7, 1);
  RequireCoordinates("CoupledDynamics: q", tree, q);
  RefuseUnrenderedFriction(tree);
  ListFreedoms();
  pose_.Set(q);
  RequireClosed("CoupledDynamics", pose_.e2().norm(), kOpen);
  hand_.X = pose_.grasp_frame();
  UpdateInertia();
  UpdateVelocities();
  BiasForces();
  regularisation_ = VectorXd::Constant(tree.nv, kRegularisation / T_ * M_.diagonal().maxCoeff());
  BuildSystem();
  AddCoupling();
  AddRegularisation();
  const double rows = pose_.C().squaredNorm();
  if (rows > 0) system_.SetWeight(kLoopWeight * A_.trace() / rows);
  system_.SetConstraints(pose_.C());
}

/// A freedom that nothing resists, such as the spin of a rod without mass between two balls, would
/// move by rounding, which the weight of the loops makes large. Its coordinates get an inertia that
/// is still nothing beside the rest.
void CoupledDynamics::AddRegularisation() {
  constexpr double kSpinRegularisation = 1e-8, kTakesPart = 0.1;
  const MatrixXd N = FindNullSpace(pose_.C(), kRankTolerance).basis;
  if (N.cols() == 0) return;
  const MatrixXd M = M_.topLeftCorner(tree_.nv, tree_.nv);
  const MatrixXd idle = N * FindKernel(N.transpose() * M * N, kNoInertia * M.diagonal().maxCoeff());
  for (Eigen::Index k = 0; k < idle.cols(); ++k) {
    const double largest = idle.col(k).cwiseAbs().maxCoeff();
    for (int v = 0; v < tree_.nv; ++v) {
      if (std::abs(idle(v, k)) > kTakesPart * largest)
        regularisation_[v] = kSpinRegularisation * A_.trace();
    }
  }
}

void CoupledDynamics::ListFreedoms() {
  for (const TreeNode& node : tree_.nodes) {
    if (node.v < 0 || node.motion == NodeMotion::kSpherical) continue;
    const Joint& joint = tree_.mechanism.joints[node.joint];
    const bool alone = joint.type == JointType::kUniversal;  // two pins, each slides for itself
    const Freedom freedom{node.q,
                          node.v,
                          joint.passive[node.freedom],
                          joint.lower[node.freedom],
                          joint.upper[node.freedom],
                          3 * node.joint + (alone ? node.freedom : 0)};
    if (IsPassive(freedom.passive) || freedom.lower > -kNoLimit || freedom.upper < kNoLimit) {
      freedoms_.push_back(freedom);
    }
  }
}

void CoupledDynamics::Stop() noexcept {
  v_.setZero();
  lost_ = 0;
  UpdateVelocities();
}

void CoupledDynamics::GraspAt(const GraspFrame& grasp) noexcept {
  pose_.SetGrasp(grasp);
  pose_.SetJacobians();
  coupled_ = true;
}

CoupledStatus CoupledDynamics::Step(const Posed& X_WH, const Vector6d& V_WH) noexcept {
  return Step({FrameOf(X_WH), ScrewOf(V_WH)});
}

CoupledStatus CoupledDynamics::Step(const MovingFrame& hand) noexcept {
  hand_ = hand;
  UpdateError();
  const double before = Energy();
  BiasForces();
  BuildSystem();
  AddCoupling();
  // Where it slips, a rough velocity tells in which direction.
  const Solving first = slipping_ ? Solving::kRoughly : Solving::kFully;
  if (!SolveWithLimits(first)) return CoupledStatus::kFailed;
  if (Slip()) {
    BuildSystem();
    pose_.AddForces(w_, &right_);
    if (!SolveWithLimits(Solving::kFully)) return CoupledStatus::kFailed;
  } else if (first == Solving::kRoughly) {
    if (!SolveWithLimits(Solving::kFully)) return CoupledStatus::kFailed;
    Slip();
  }
  FindWrenches();
  const CoupledStatus status = Move();
  UpdateError();
  if (status == CoupledStatus::kMoved) LimitEnergyGain(before);
  return status;
}

/// h(q, v), and -T C' v, of which the next velocities must make up for.
void CoupledDynamics::BiasForces() noexcept {
  pose_.ComputeLoopBias(-T_, &d_);
  pose_.ComputeForces(&bias_);
}

/// A v+ = right but for coupling, loops and limits.
void CoupledDynamics::BuildSystem() noexcept {
  const double rate = 1 / T_;
  A_ = rate * M_;
  right_ = rate * momenta_ - bias_;
  A_.diagonal() += regularisation_;
  AddPassive();
}

void CoupledDynamics::AddCoupling() noexcept {
  if (!coupled_) return;
  pose_.ComputeWeightedJacobian(coupling_.root_gain, &rootKJ_);
  system_.AddGram(rootKJ_, &A_);
  pose_.AddForces(Scaled(coupling_.stiffness, e1_) + Scaled(coupling_.damping, hand_.V), &right_);
}

/// The coupling's wrench at the end of the step. True if it is larger than it may be; then w_ is
/// shortened to that.
bool CoupledDynamics::Slip() noexcept {
  if (!coupled_) {
    w_ = {};
    return slipping_ = false;
  }
  const Screw V_WG = pose_.Twist(next_v_);
  w_ = Scaled(coupling_.stiffness, e1_ - T_ * V_WG) + Scaled(coupling_.damping, hand_.V - V_WG);
  const bool force_slips = Shorten(coupling_.max_force, &w_.linear);
  const bool moment_slips = Shorten(coupling_.max_moment, &w_.angular);
  return slipping_ = force_slips || moment_slips;
}

/// Velocities with the joints' limits; those that held last are tried first.
bool CoupledDynamics::SolveWithLimits(Solving how) noexcept {
  for (int i = 0; i < kContactChanges; ++i) {
    if (!SolveVelocity(how)) return false;
    if (!ChangeContacts()) break;
  }
  return true;
}

/// Springs and friction of the tree's joints; dry friction as the damper that it is at this speed,
/// of all freedoms of a contact together.
void CoupledDynamics::AddPassive() noexcept {
  for (size_t first = 0, end = 0; first < freedoms_.size(); first = end) {
    double square = 0;
    for (; end < freedoms_.size() && freedoms_[end].sliding == freedoms_[first].sliding; ++end) {
      const double power = freedoms_[end].passive.coulomb * v_[freedoms_[end].v];
      square += power * power;
    }
    const double power = std::sqrt(square);
    for (size_t i = first; i < end; ++i) {
      const auto& [q, v, passive, lower, upper, sliding, contact] = freedoms_[i];
      const double dry = FrictionDamping(passive.coulomb, power, kSlowSliding);
      A_(v, v) += T_ * passive.stiffness + passive.viscous + dry;
      right_[v] -= passive.stiffness * (q_[q] - passive.rest);
    }
  }
}

/// (A + limits) v+ + C' mu = right, C v+ = d.
bool CoupledDynamics::SolveVelocity(Solving how) noexcept {
  if (at_limit_) AddLimits();
  const MatrixXd& A = at_limit_ ? limited_A_ : A_;
  const VectorXd& right = at_limit_ ? limited_right_ : right_;
  if (!system_.Factor(A)) return false;
  if (how == Solving::kRoughly) {
    system_.Approach(pose_.C(), right, d_, &next_v_);
  } else {
    system_.Solve(A, pose_.C(), right, d_, &next_v_);
  }
  return std::isfinite(SquaredSpeed(next_v_));
}

void CoupledDynamics::AddLimits() noexcept {
  limited_A_ = A_;
  limited_right_ = right_;
  for (const auto& [q, v, passive, lower, upper, sliding, contact] : freedoms_) {
    if (contact == 0) continue;
    const double hold = kHardLimit * A_(v, v);
    limited_A_(v, v) += hold;
    limited_right_[v] += hold * ((contact > 0 ? upper : lower) - q_[q]) / T_;
  }
}

/// Limits that the step would pass begin to hold, limits that would pull let go. True if any did.
bool CoupledDynamics::ChangeContacts() noexcept {
  bool changed = false;
  at_limit_ = false;
  for (auto& [q, v, passive, lower, upper, sliding, contact] : freedoms_) {
    const double end = q_[q] + T_ * next_v_[v];
    const double above = end - upper, below = lower - end;
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
    at_limit_ |= contact != 0;
  }
  return changed;
}

/// The joints' wrenches, with the accelerations of the step.
void CoupledDynamics::FindWrenches() noexcept {
  vdot_ = (next_v_ - v_) / T_;
  pose_.SetAccelerations(vdot_);
  system_.ComputeMultipliers(pose_.C(), d_, &mu_);
  pose_.LoadJoints(w_, mu_, &joints_);
}

CoupledStatus CoupledDynamics::Move() noexcept {
  const double way2 = T_ * T_ * SquaredSpeed(next_v_);
  if (way2 > kFarthest * kFarthest) next_v_ *= kFarthest / std::sqrt(way2);
  const bool closed = Close();
  if (closed) {
    q_.swap(next_q_);
    v_.swap(next_v_);
    pose_.SetJacobians();
  } else {
    v_.setZero();
    last_closure_defect_.setZero();
    pose_.Set(q_);
  }
  system_.SetConstraints(pose_.C());
  UpdateInertia();
  UpdateVelocities();
  if (!std::isfinite(Power(w_, w_))) return CoupledStatus::kFailed;
  return closed ? CoupledStatus::kMoved : CoupledStatus::kStopped;
}

/// Where the step leads, q+ = q (+) T v+, and from there chord steps C dq = e2. The first goes
/// along with the step.
bool CoupledDynamics::Close() noexcept {
  if (tree_.loops.empty()) {
    x_ = T_ * next_v_;
  } else {
    PredictClosure();
  }
  next_q_ = q_;
  for (int i = 0;; ++i) {
    MoveCoordinates(tree_, x_.data(), next_q_.data());
    pose_.SetLoops(next_q_);
    if (tree_.loops.empty()) return true;
    const VectorXd& e2 = pose_.e2();
    if (i == 0) last_closure_defect_ += e2;
    squared_closure_ = DotOfFours(e2.data(), e2.data(), static_cast<int>(e2.size()));
    if (i == kClosingSteps || squared_closure_ <= kClosed * kClosed ||
        !std::isfinite(squared_closure_)) {
      return squared_closure_ <= kStillClosed * kStillClosed;
    }
    system_.Approach(pose_.C(), rest_, e2, &x_);
  }
}

/// Adds to the step what closes the loops at its end, where it leaves errors of
///
///   e2 - T C v+ - T^2/2 C'(v+) v+ = e2 - T d - T^2/2 C'(v+) v+
///
/// and, to third order, the same as the last step. While a mechanism goes on in the direction of
/// the last step, as it must with a single freedom, C'v grows with the square of the speed.
void CoupledDynamics::PredictClosure() noexcept {
  const double speed2 = SquaredSpeed(v_);
  const double along = speed2 > 0 ? Dot(next_v_.data(), v_.data(), tree_.nv) / speed2 : 0;
  x_ = next_v_ - along * v_;
  const double aside2 = SquaredSpeed(x_) / (kSameWay * kSameWay);
  if (std::abs(along) < kMuchFaster && aside2 < SquaredSpeed(next_v_)) {
    predicted_defect_ = pose_.e2() - (T_ * (1 - 0.5 * along * along)) * d_ + last_closure_defect_;
  } else {
    pose_.SetVelocities(next_v_);
    pose_.ComputeLoopBias(-0.5 * T_ * T_, &predicted_defect_);
    predicted_defect_ += pose_.e2() - T_ * d_ + last_closure_defect_;
  }
  system_.Approach(pose_.C(), rest_, predicted_defect_, &correction_);
  x_ = T_ * next_v_ + correction_;
}

/// Inertia, and the energies without the coupling's.
void CoupledDynamics::UpdateInertia() noexcept {
  pose_.ComputeMassMatrix(&M_);
  potential_ = pose_.WeightEnergy();
  for (const auto& [q, v, passive, lower, upper, sliding, contact] : freedoms_) {
    const double length = q_[q] - passive.rest;
    potential_ += 0.5 * passive.stiffness * length * length;
  }
}

void CoupledDynamics::UpdateVelocities() noexcept {
  pose_.SetVelocities(v_);
  system_.Product(M_, v_, &momenta_);
  kinetic_ = 0.5 * Dot(momenta_.data(), v_.data(), tree_.nv);
}

/// What the step has gained beyond the damper's work at most gives back what steps have lost; the
/// rest is taken out of the velocities.
void CoupledDynamics::LimitEnergyGain(double before) noexcept {
  constexpr double kMemory = 0.05;  // of the kinetic energy that losses are remembered for
  const Screw V = pose_.Twist(v_);
  const double dragged = T_ * Power(Scaled(coupling_.damping, hand_.V - V), V);
  const double gained = Energy() - before - (coupled_ ? std::max(0.0, dragged) : 0);
  lost_ = std::min(lost_ - gained, kMemory * kinetic_);
  if (lost_ >= 0 || kinetic_ == 0) return;
  v_ *= std::sqrt(std::max(0.0, 1 + lost_ / kinetic_));
  lost_ = 0;
  UpdateVelocities();
}

/// e1, and the energy of the coupling.
void CoupledDynamics::UpdateError() noexcept {
  const Screw e1 = HandError(pose_.grasp_frame(), hand_.X);
  e1_ = e1;
  if (!coupled_) return;
  const Screw pull = Scaled(coupling_.stiffness, e1);
  spring_ = SpringEnergy(e1.linear, pull.linear, coupling_.max_force) +
            SpringEnergy(e1.angular, pull.angular, coupling_.max_moment);
}

double CoupledDynamics::closure() const noexcept {
  return std::sqrt(squared_closure_);
}

Vector6d CoupledDynamics::e1() const noexcept {
  return Vector6Of(e1_);
}

Vector6d CoupledDynamics::w() const noexcept {
  return Vector6Of(w_);
}

Vector6d CoupledDynamics::V_WG() const noexcept {
  return Vector6Of(pose_.Twist(v_));
}

}  // namespace vmech
