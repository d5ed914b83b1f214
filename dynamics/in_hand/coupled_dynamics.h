#pragma once

#include <span>
#include <vector>

#include "vmech/dynamics/in_hand/closing_step.h"
#include "vmech/dynamics/in_hand/energy_limit.h"
#include "vmech/dynamics/in_hand/fading_wrench.h"
#include "vmech/dynamics/in_hand/passive_joints.h"
#include "vmech/dynamics/in_hand/virtual_coupling.h"

namespace vmech {

/// What a step of CoupledDynamics came to.
enum class CoupledStatus {
  kMoved,
  kStopped,  ///< the loops do not close where the step leads: the pose stays, at rest
  kFailed,   ///< a value is not finite; the pose stays, the wrenches are undefined
};

/// What a change of a mechanism's design came to.
enum class DesignStatus {
  kTaken,
  kTooFar,  ///< a coupling would pull too much more; the mechanism is as it was
  kOpen,    ///< the loops do not close; the mechanism is as it was
};

/// How a hand holds a mechanism.
struct CoupledGrasp {
  GraspFrame frame;       ///< on its link, or a point of it
  HandCoupling coupling;  ///< rotational rows do not count for a point grasp
};

/// Forward dynamics of a mechanism that hands hold, each by a spring and a damper: it moves by its
/// own equations of motion, a step of T at a time, so that no acceleration of the hand is needed
/// and every freedom takes part, whether the grasp reaches it or not [Colgate et al. 1995, virtual
/// coupling]. With the hand's error e1 and twist V_H, coupling, joint springs, friction and limits
/// taken at the end of the step,
///
///   M (v+ - v)/T + h = J' w - C' mu + passive(v+),   C v+ = -T C' v,
///   w = K (e1 - T J v+) + B (V_H - J v+),            q+ = q (+) T v+, loops closed,
///
/// that is (M/T + J'(B + T K) J + ..) v+ = M v/T - h + J'(K e1 + B V_H) - C' mu: what the hand
/// feels, -w, is the reaction of a mass that really moves. Implicit steps only lose energy; what
/// centrifugal forces, taken at the start of the step, add beyond what was lost before is taken out
/// of the velocities. Velocities and multipliers are those of a SaddleSystem; redundant loop
/// equations need no care. Of several hands, J'w and the gains are sums. Where a hand is not named,
/// the first is meant. No allocation after construction.
class CoupledDynamics {
 public:
  /// Keeps a reference to the tree. `hands`: at least one. `step` [s] in [1e-7, 1]; `q`: a closed
  /// pose.
  /// @throws std::invalid_argument as RefuseUnrenderedFriction, or if the step or a gain is out of
  /// range.
  CoupledDynamics(const KinematicTree& tree, std::span<const CoupledGrasp> hands, double step,
                  const VectorXd& q);
  /// The same in one hand.
  CoupledDynamics(const KinematicTree& tree, const GraspFrame& grasp, const HandCoupling& coupling,
                  double step, const VectorXd& q);

  /// The mechanism is at rest from now on, and wrenches that were fading are gone.
  void Stop() noexcept;
  /// Held at another frame of the same kind, or again after LetGo.
  void GraspAt(const GraspFrame& grasp, int hand = 0) noexcept;
  /// The hand holds it no more: the coupling exerts nothing until GraspAt.
  void LetGo(int hand = 0) noexcept;
  /// The same, but the wrench of the coupling fades, its force no faster than `rate` [N/s].
  void Loosen(double rate, int hand = 0) noexcept;
  /// The largest wrench that may pull from now on, beside that of the coupling itself.
  void Within(const WrenchLimit& room, int hand = 0) noexcept {
    hands_[hand].coupling.Within(room);
  }
  /// Energy [J] that the mechanism has and the hand did not give: the next step takes it out of the
  /// velocities, as far as they have it.
  void Owe(double energy) noexcept { energy_limit_.Owe(energy); }
  /// Takes the numbers of the design `to` in place of `from`, which it has: the loops are closed
  /// anew near the present pose, with as little motion against inertia and couplings as can be. Its
  /// parts keep their velocities, and what the change itself would move is left out. `most`: by how
  /// much the force and the moment of a coupling may change [N], [N m].
  [[nodiscard]] DesignStatus ChangeDesign(const HeldDesign& from, const HeldDesign& to,
                                          const WrenchLimit& most) noexcept;
  /// Work of all changes of design on the mechanism [J]: by how much they have raised its energy.
  double design_work() const noexcept { return design_work_; }
  /// Where a hand is in the next step, and how it moves; it stays there.
  void SetHand(const MovingFrame& frame, int hand = 0) noexcept { hands_[hand].at = frame; }
  /// One period further, every hand where SetHand left it.
  [[nodiscard]] CoupledStatus Step() noexcept;
  /// A step with the first hand at X_WH, moving with V_WH [v; w] at Ho, world axes; or with its
  /// frame in W.
  [[nodiscard]] CoupledStatus Step(const Posed& X_WH, const Vector6d& V_WH) noexcept;
  /// A step with the first hand at a frame that moves in W.
  [[nodiscard]] CoupledStatus Step(const MovingFrame& hand) noexcept;

  // After the last step.
  int hands() const noexcept { return static_cast<int>(hands_.size()); }  ///< at least 1
  const VectorXd& q() const noexcept { return q_; }                       ///< [nq], loops closed
  auto v() const noexcept { return v_.head(tree_.nv); }                   ///< [nv]
  /// Grasp frame in the world.
  Posed X_WG(int hand = 0) const noexcept { return pose_.X_WG(hand); }
  /// HandError of the hand [6; m, rad].
  Vector6d e1() const noexcept;
  /// The same of any hand, as kernels hold it.
  const Screw& stretch(int hand = 0) const noexcept { return hands_[hand].coupling.e1(); }
  /// The mechanism at q(), with its Jacobians and inertias.
  const GraspedMechanism& pose() const noexcept { return pose_; }
  Vector6d V_WG(int hand = 0) const noexcept;  ///< of Go, world axes [v; w]
  /// Hand on mechanism during the step, at Go, world axes: what the coupling pulls, and what of it
  /// fades.
  Vector6d w(int hand = 0) const noexcept;
  const Screw& pull(int hand = 0) const noexcept { return w_[hand]; }  ///< w, as kernels hold it
  /// Every joint's wrench during the step, as HandDynamics::joints.
  const std::vector<Wrenchd>& joints() const noexcept { return joints_; }
  /// Kinetic energy, weight, springs of joints and couplings [J].
  double Energy() const noexcept;
  /// What steps have lost and later ones may give back [J]: at most a twentieth of the kinetic
  /// energy. With it, the energy grows by the hands' work alone.
  double RememberedLosses() const noexcept { return energy_limit_.remembered(); }
  /// Energy of a hand's spring, and of what fades of it [J].
  double CouplingEnergy(int hand = 0) const noexcept {
    return hands_[hand].coupling.energy() + hands_[hand].fading.energy();
  }
  double closure() const noexcept { return closing_.closure(); }  ///< loop errors, lengths over L
  bool at_limit() const noexcept { return passive_.at_limit(); }  ///< a joint stands at one
  bool slipping() const noexcept;  ///< a coupling is at its largest wrench

 private:
  struct Hand {
    VirtualCoupling coupling;
    FadingWrench fading;
    MovingFrame at;
    bool coupled = true;
  };

  void AddRegularisation();
  void BiasForces() noexcept;
  void BuildSystem() noexcept;
  void AddCouplings() noexcept;
  void Fade() noexcept;
  bool SolveStep() noexcept;
  bool SolveWithLimits() noexcept;
  bool SolveVelocity() noexcept;
  bool Slip() noexcept;
  void FindWrenches() noexcept;
  CoupledStatus Move() noexcept;
  DesignStatus Reassemble(const WrenchLimit& most) noexcept;
  void UpdateInertia() noexcept;
  void UpdateVelocities() noexcept;
  void Stretch() noexcept;
  void LimitEnergyGain(double before) noexcept;

  const KinematicTree& tree_;
  double T_;
  GraspedMechanism pose_;
  std::vector<Hand> hands_;
  PassiveJoints passive_;
  SaddleSystem system_;
  ClosingStep closing_;
  EnergyLimit energy_limit_;
  MatrixXd M_, A_, limited_A_, rootKJ_;
  VectorXd q_, v_, next_q_, next_v_, vdot_, momenta_, bias_, right_, limited_right_, mu_, d_;
  VectorXd regularisation_;  // of every freedom [as M/T]: holds those without inertia
  std::vector<Wrenchd> joints_;
  std::vector<Screw> w_;                // of every hand
  double kinetic_ = 0, potential_ = 0;  // without the couplings' [J]
  double design_work_ = 0;              // [J]
};

}  // namespace vmech
