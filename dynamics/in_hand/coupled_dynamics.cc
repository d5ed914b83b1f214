#include "vmech/dynamics/in_hand/coupled_dynamics.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "vmech/base/check_range.h"
#include "vmech/base/linear_algebra/linear_algebra.h"
#include "vmech/base/linear_algebra/small_ldlt.h"
#include "vmech/base/screw_algebra.h"
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
constexpr int kContactChanges = 3;
constexpr double kOpen = 1e-6;     // loops at the start; poses of files close to 1e-13
constexpr double kFarthest = 0.1;  // [rad] and [m] that the coordinates move in a step

/// n columns, and zeros that fill up whole registers.
MatrixXd PaddedSquare(int n) {
  return MatrixXd::Zero(n, PaddedSize(n));
}

double SquaredSpeed(const VectorXd& v) {
  return DotOfDouble4(v.data(), v.data(), static_cast<int>(v.size()));
}

std::vector<GraspFrame> FramesOf(std::span<const CoupledGrasp> hands) {
  std::vector<GraspFrame> frames;
  for (const CoupledGrasp& hand : hands) frames.push_back(hand.frame);
  return frames;
}

}  // namespace

CoupledDynamics::CoupledDynamics(const KinematicTree& tree, const GraspFrame& grasp,
                                 const HandCoupling& coupling, double step, const VectorXd& q)
    : CoupledDynamics(tree, std::array{CoupledGrasp{grasp, coupling}}, step, q) {}

CoupledDynamics::CoupledDynamics(const KinematicTree& tree, std::span<const CoupledGrasp> hands,
                                 double step, const VectorXd& q)
    : tree_(tree),
      T_(step),
      pose_(tree, FramesOf(hands)),
      passive_(tree),
      system_(tree.nv, static_cast<int>(pose_.C().rows())),
      closing_(tree, pose_),
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
      mu_(pose_.e2()),
      d_(mu_),
      joints_(tree.mechanism.joints.size()),
      w_(hands.size()) {
  CheckRange("CoupledDynamics", "step", step, 1e-7, 1);
  RequireCoordinates("CoupledDynamics: q", tree, q);
  pose_.Set(q);
  RequireClosed("CoupledDynamics", pose_.e2().norm(), kOpen);
  for (const CoupledGrasp& hand : hands) {
    hands_.push_back({VirtualCoupling(hand.coupling, hand.frame.kind, step), {}, {}});
    hands_.back().at.X = pose_.grasp_frame(static_cast<int>(hands_.size()) - 1);
  }
  UpdateInertia();
  UpdateVelocities();
  BiasForces();
  regularisation_ = VectorXd::Constant(tree.nv, kRegularisation / T_ * M_.diagonal().maxCoeff());
  BuildSystem();
  // Weights count the first hand alone, so that another that does not hold changes nothing.
  for (Hand& hand : hands_) hand.coupled = &hand == &hands_.front();
  AddCouplings();
  for (Hand& hand : hands_) hand.coupled = true;
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

void CoupledDynamics::Stop() noexcept {
  v_.setZero();
  for (Hand& hand : hands_) hand.fading = {};
  energy_limit_.Forget();
  UpdateVelocities();
}

void CoupledDynamics::GraspAt(const GraspFrame& grasp, int hand) noexcept {
  pose_.SetGrasp(grasp, hand);
  pose_.SetJacobians();
  hands_[hand].coupled = true;
}

void CoupledDynamics::LetGo(int hand) noexcept {
  hands_[hand].coupled = false;
  hands_[hand].coupling.LetGo();
}

void CoupledDynamics::Loosen(double rate, int hand) noexcept {
  FadingWrench& fading = hands_[hand].fading;
  fading = FadingWrench(hands_[hand].coupling.stiffness(), rate, T_);
  fading.Add(w_[hand]);
  LetGo(hand);
}

DesignStatus CoupledDynamics::ChangeDesign(const HeldDesign& from, const HeldDesign& to,
                                           const WrenchLimit& most) noexcept {
  Stretch();
  const double before = Energy();
  pose_.ChangeDesign(from, to);
  passive_.Take(to);
  const DesignStatus status = Reassemble(most);
  if (status == DesignStatus::kTaken) {
    q_.swap(next_q_);
    closing_.Restart();
  } else {
    pose_.ChangeDesign(to, from);
    passive_.Take(from);
    pose_.SetLoops(q_);
  }
  pose_.SetJacobians();
  system_.SetConstraints(pose_.C());
  UpdateInertia();
  UpdateVelocities();
  Stretch();
  if (status == DesignStatus::kTaken) design_work_ += Energy() - before;
  return status;
}

/// Closes the loops of the new numbers from q_ to next_q_, against the matrix of the last step.
DesignStatus CoupledDynamics::Reassemble(const WrenchLimit& most) noexcept {
  if (!system_.Factor(A_)) return DesignStatus::kOpen;
  pose_.SetLoops(q_);
  if (!closing_.Reclose(q_, &system_, &pose_, &next_q_)) return DesignStatus::kOpen;
  for (int i = 0; i < hands(); ++i) {
    const Hand& hand = hands_[i];
    if (!hand.coupled) continue;
    const Screw way = HandError(pose_.FindGraspFrame(i), pose_.grasp_frame(i));
    const Screw change = Scaled(hand.coupling.stiffness(), way);
    if (Length(change.linear) > most.force || Length(change.angular) > most.moment) {
      return DesignStatus::kTooFar;
    }
  }
  return DesignStatus::kTaken;
}

CoupledStatus CoupledDynamics::Step(const Posed& X_WH, const Vector6d& V_WH) noexcept {
  return Step({FrameOf(X_WH), ScrewOf(V_WH)});
}

CoupledStatus CoupledDynamics::Step(const MovingFrame& hand) noexcept {
  SetHand(hand);
  return Step();
}

CoupledStatus CoupledDynamics::Step() noexcept {
  Stretch();
  const double before = Energy();
  Fade();
  BiasForces();
  if (!SolveStep()) return CoupledStatus::kFailed;
  FindWrenches();
  const CoupledStatus status = Move();
  Stretch();
  if (status == CoupledStatus::kMoved) LimitEnergyGain(before);
  return status;
}

/// What hands that have let go still pull.
void CoupledDynamics::Fade() noexcept {
  for (int i = 0; i < hands(); ++i) {
    FadingWrench& fading = hands_[i].fading;
    if (fading.acts()) fading.Step(pose_.Twist(v_, i) - hands_[i].at.V);
  }
}

/// Velocities at the end of the step, and the couplings' wrenches. What of these turns out too
/// large is given at its largest from then on, so that the mechanism gets what the hands pay for.
bool CoupledDynamics::SolveStep() noexcept {
  for (int i = 0; i < hands(); ++i) {
    if (hands_[i].coupled) hands_[i].coupling.Foresee(pose_.Twist(v_, i));
  }
  do {
    BuildSystem();
    AddCouplings();
    if (!SolveWithLimits()) return false;
  } while (Slip());
  return true;
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
  passive_.AddTo(q_, v_, T_, &A_, &right_);
}

void CoupledDynamics::AddCouplings() noexcept {
  for (int i = 0; i < hands(); ++i) {
    const Hand& hand = hands_[i];
    if (hand.coupled) {
      pose_.ComputeWeightedJacobian(hand.coupling.RootGain(), &rootKJ_, i);
      system_.AddGram(rootKJ_, &A_);
      pose_.AddForces(hand.coupling.Given(), &right_, i);
    }
    if (hand.fading.acts()) pose_.AddForces(hand.fading.w(), &right_, i);
  }
}

/// The couplings' wrenches at the end of the step. True if more of them slips.
bool CoupledDynamics::Slip() noexcept {
  bool more = false;
  for (int i = 0; i < hands(); ++i) {
    Hand& hand = hands_[i];
    if (hand.coupled && hand.coupling.Pull(pose_.Twist(next_v_, i))) more = true;
  }
  return more;
}

/// Velocities with the joints' limits; those that held last are tried first.
bool CoupledDynamics::SolveWithLimits() noexcept {
  for (int i = 0; i < kContactChanges; ++i) {
    if (!SolveVelocity()) return false;
    if (!passive_.ChangeLimits(q_, next_v_, T_)) break;
  }
  return true;
}

/// (A + limits) v+ + C' mu = right, C v+ = d.
bool CoupledDynamics::SolveVelocity() noexcept {
  const bool limited = passive_.at_limit();
  if (limited) {
    limited_A_ = A_;
    limited_right_ = right_;
    passive_.AddLimits(q_, T_, &limited_A_, &limited_right_);
  }
  const MatrixXd& A = limited ? limited_A_ : A_;
  const VectorXd& right = limited ? limited_right_ : right_;
  if (!system_.Factor(A)) return false;
  system_.Solve(A, pose_.C(), right, d_, &next_v_);
  return std::isfinite(SquaredSpeed(next_v_));
}

/// The joints' wrenches, with the accelerations of the step.
void CoupledDynamics::FindWrenches() noexcept {
  vdot_ = (next_v_ - v_) / T_;
  pose_.SetAccelerations(vdot_);
  system_.ComputeMultipliers(pose_.C(), d_, &mu_);
  for (int i = 0; i < hands(); ++i) w_[i] = hands_[i].coupling.w() + hands_[i].fading.w();
  pose_.LoadJoints(w_, mu_, &joints_);
}

CoupledStatus CoupledDynamics::Move() noexcept {
  const double way2 = T_ * T_ * SquaredSpeed(next_v_);
  if (way2 > kFarthest * kFarthest) next_v_ *= kFarthest / std::sqrt(way2);
  const bool closed = closing_.Close(q_, v_, next_v_, d_, T_, &system_, &pose_, &next_q_);
  if (closed) {
    q_.swap(next_q_);
    v_.swap(next_v_);
    pose_.SetJacobians();
  } else {
    v_.setZero();
    closing_.Restart();
    pose_.Set(q_);
  }
  system_.SetConstraints(pose_.C());
  UpdateInertia();
  UpdateVelocities();
  for (const Screw& w : w_) {
    if (!std::isfinite(Power(w, w))) return CoupledStatus::kFailed;
  }
  return closed ? CoupledStatus::kMoved : CoupledStatus::kStopped;
}

/// Inertia, and the energies without the coupling's.
void CoupledDynamics::UpdateInertia() noexcept {
  pose_.ComputeMassMatrix(&M_);
  potential_ = pose_.WeightEnergy() + passive_.Energy(q_);
}

void CoupledDynamics::UpdateVelocities() noexcept {
  pose_.SetVelocities(v_);
  system_.Product(M_, v_, &momenta_);
  kinetic_ = 0.5 * Dot(momenta_.data(), v_.data(), tree_.nv);
}

/// What the step has gained beyond the dampers' work at most.
void CoupledDynamics::LimitEnergyGain(double before) noexcept {
  double gained = Energy() - before;
  for (const Hand& hand : hands_) {
    if (hand.coupled) gained -= hand.coupling.dragged();
  }
  const double factor = energy_limit_.FactorOfVelocities(gained, kinetic_);
  if (factor == 1) return;
  v_ *= factor;
  UpdateVelocities();
}

void CoupledDynamics::Stretch() noexcept {
  for (int i = 0; i < hands(); ++i) {
    Hand& hand = hands_[i];
    hand.coupling.Stretch(pose_.grasp_frame(i), hand.at);
    if (!hand.coupled) hand.coupling.LetGo();
  }
}

double CoupledDynamics::Energy() const noexcept {
  double energy = kinetic_ + potential_;
  for (int i = 0; i < hands(); ++i) energy += CouplingEnergy(i);
  return energy;
}

bool CoupledDynamics::slipping() const noexcept {
  return std::any_of(hands_.begin(), hands_.end(),
                     [](const Hand& hand) { return hand.coupling.slipping(); });
}

Vector6d CoupledDynamics::e1() const noexcept {
  return Vector6Of(stretch());
}

Vector6d CoupledDynamics::w(int hand) const noexcept {
  return Vector6Of(w_[hand]);
}

Vector6d CoupledDynamics::V_WG(int hand) const noexcept {
  return Vector6Of(pose_.Twist(v_, hand));
}

}  // namespace vmech
