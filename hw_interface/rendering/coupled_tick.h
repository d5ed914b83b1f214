#pragma once

#include "vmech/dynamics/in_hand/coupled_dynamics.h"
#include "vmech/hw_interface/rendering/closing_hand.h"
#include "vmech/hw_interface/rendering/peak_forces.h"
#include "vmech/hw_interface/rendering/tick.h"

namespace vmech {

/// What a CoupledTick couples by, and how fast it takes hold and lets go.
struct CoupledTickOptions {
  /// Spring and damper as the hand feels them (CouplingOf). Stiffer feels truer and calls for a
  /// faster device.
  HandCoupling coupling;
  /// Force at the hand over force at the mechanism, in [1e-6, 1e3]: 0.1 makes it ten times as
  /// light.
  double scale = 1;
  /// Fastest growth of the force at a grasp, and its fall at a release [N/s], in [10, 1e6]; lower
  /// is softer, and a fast link slips further through the hand.
  double grasp_rate = 1000;
  /// Time constant of the hand's velocity where nobody observes it [s], in [0, 0.1].
  double smoothing = 2e-3;

  /// @throws std::invalid_argument naming field, value and range.
  void Validate() const;
};

/// Ticks in which each thing happened since the hand took hold.
struct CoupledSummary {
  long ticks = 0;
  long at_limit = 0;         ///< a joint stood at a limit
  long slipping = 0;         ///< the coupling was at its largest wrench
  long stopped = 0;          ///< the loops did not close where the motion led; it stopped before
  double worst_closure = 0;  ///< [-], lengths over the characteristic length
  double farthest = 0;       ///< hand from grasp frame [m]

  std::string BriefReport() const;
};

/// The second architecture: a mechanism that moves by its own dynamics, and between it and the hand
/// a spring and a damper (CoupledDynamics). The hand feels true inertia at frequencies far below
/// that of the mechanism on the spring, needs no acceleration, and can let freedoms go that its
/// grasp does not reach. A hand that closes on a link, however fast, takes hold of it with a force
/// that grows no faster than `grasp_rate` (ClosingHand); one that lets go feels the last wrench
/// fade out as slowly, and the mechanism moves alone. No allocation after construction.
class CoupledTick : public Tick {
 public:
  /// Keeps a reference to the tree. `q`: a closed pose, where the hand takes hold.
  /// @throws std::invalid_argument as Validate and CoupledDynamics.
  CoupledTick(const KinematicTree& tree, int grasp, const VectorXd& q, double period,
              const CoupledTickOptions& options);

  std::vector<std::string> ChannelNames() const override;
  std::vector<std::string> StateNames() const override;
  Posed GraspFrame() const noexcept override { return dynamics_.X_WG(); }
  bool UsesObservedHand() const noexcept override { return true; }
  /// The link whose skeleton, the lines between its anchors, is nearest; held as it is there.
  bool GraspAt(const Posed& X_WH) noexcept override;
  void Reset() noexcept override;
  TickOutput Step(const TickInput& input, std::span<double> channels) noexcept override;

  void Show(TickPicture* picture) const noexcept override;

  const CoupledDynamics& dynamics() const noexcept { return dynamics_; }
  const CoupledSummary& summary() const noexcept { return summary_; }
  /// Largest force of each joint since the hand took hold [N].
  const std::vector<double>& peak_forces() const noexcept { return peaks_.forces(); }
  std::string FullReport() const override;

 private:
  void ReadHand(const TickInput& input) noexcept;
  CoupledStatus Move(const TickInput& input) noexcept;
  void Feel(bool held) noexcept;
  void Fade() noexcept;
  double FadingEnergy() const noexcept;
  void Account(CoupledStatus status, std::span<double> channels) noexcept;

  const KinematicTree& tree_;
  CoupledTickOptions options_;
  vmech::GraspFrame grasp_;  // where the hand takes hold by name
  CoupledDynamics dynamics_;
  double period_, fade_;  // fade_: what is left of a fading wrench after a period
  Screw compliance_;      // K^-1, zero where K is
  ClosingHand closing_;
  bool has_hand_ = false, holds_ = true;
  Screw felt_;         // of the mechanism that is held
  Screw fading_;       // of one that was
  double stored_ = 0;  // when it was last held [J]
  MovingFrame hand_;
  PeakForces peaks_;
  CoupledSummary summary_;
};

}  // namespace vmech
