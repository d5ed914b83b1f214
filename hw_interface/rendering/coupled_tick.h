#pragma once

#include <span>
#include <string>
#include <vector>

#include "vmech/dynamics/in_hand/coupled_dynamics.h"
#include "vmech/hw_interface/rendering/closing_hand.h"
#include "vmech/hw_interface/rendering/energy_shares.h"
#include "vmech/hw_interface/rendering/peak_forces.h"
#include "vmech/hw_interface/rendering/tick.h"

namespace vmech {

/// What a CoupledTick couples by, and how fast it takes hold and lets go.
struct CoupledTickOptions {
  /// Spring and damper as the only hand feels them (ChooseCoupling). Stiffer feels truer and calls
  /// for a faster device.
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

/// One of several hands that hold a mechanism.
struct CoupledHand {
  int grasp = -1;         ///< of the mechanism, by index
  HandCoupling coupling;  ///< as this hand feels it
};

/// The coupling at the mechanism, whose forces a hand feels times `scale`, for one that is given as
/// the hand feels it.
HandCoupling AtTheMechanism(HandCoupling coupling, double scale);

/// Ticks in which each thing happened since the hand took hold.
struct CoupledSummary {
  long ticks = 0;            ///< since the hand took hold
  long at_limit = 0;         ///< a joint stood at a limit
  long slipping = 0;         ///< the coupling was at its largest wrench
  long stopped = 0;          ///< the loops did not close where the motion led; it stopped before
  double worst_closure = 0;  ///< [-], lengths over the characteristic length
  double farthest = 0;       ///< hand from grasp frame [m]

  std::string BriefReport() const;  ///< a line
};

/// The second architecture: a mechanism that moves by its own dynamics, and between it and the hand
/// a spring and a damper (CoupledDynamics). The hand feels true inertia at frequencies far below
/// that of the mechanism on the spring, needs no acceleration, and can let freedoms go that its
/// grasp does not reach. A hand that closes on a link, however fast, takes hold of it with a force
/// that grows no faster than `grasp_rate` (ClosingHand); where one lets go, the last wrench fades
/// out as slowly on both sides (FadingWrench), and the mechanism moves on. Each of several hands
/// has a coupling of its own, and is told of the energy that it has stored itself (EnergyShares).
/// No allocation after construction.
class CoupledTick : public Tick {
 public:
  /// Keeps a reference to the tree. `q`: a closed pose, where the hand takes hold.
  /// @throws std::invalid_argument as Validate and CoupledDynamics.
  CoupledTick(const KinematicTree& tree, int grasp, const VectorXd& q, double period,
              const CoupledTickOptions& options);
  /// In several hands, each with its own coupling in place of the options'.
  CoupledTick(const KinematicTree& tree, std::span<const CoupledHand> hands, const VectorXd& q,
              double period, const CoupledTickOptions& options);

  std::vector<std::string> ChannelNames() const override;
  std::vector<std::string> StateNames() const override;
  Posed GraspFrame() const noexcept override { return HeldFrame(0); }
  bool UsesObservedHand() const noexcept override { return true; }
  /// The link whose skeleton, the lines between its anchors, is nearest; held as it is there.
  bool GraspAt(const Posed& X_WH) noexcept override { return HandGraspsAt(0, X_WH); }
  void Reset() noexcept override;
  TickOutput Step(const TickInput& input, std::span<double> channels) noexcept override;

  int hands() const noexcept override { return static_cast<int>(hands_.size()); }
  /// Grasp frame in the world.
  Posed HeldFrame(int hand) const noexcept override { return dynamics_.X_WG(hand); }
  /// Takes hold there, if it is near.
  bool HandGraspsAt(int hand, const Posed& X_WH) noexcept override;
  void StepHands(std::span<const TickInput> inputs, std::span<TickOutput> outputs,
                 std::span<double> channels) noexcept override;

  void Show(TickPicture* picture) const noexcept override;

  /// As CoupledDynamics::ChangeDesign, `grasps` those of the hands; what a hand feels changes by
  /// `most` at most. What the change gives the mechanism is no energy that a hand has stored.
  [[nodiscard]] DesignStatus ChangeDesign(const HeldDesign& from, const HeldDesign& to,
                                          const WrenchLimit& most) noexcept;

  /// The mechanism, as the last step left it.
  const CoupledDynamics& dynamics() const noexcept { return dynamics_; }
  const CoupledSummary& summary() const noexcept { return summary_; }  ///< since the hand took hold
  /// Largest force of each joint since the hand took hold [N].
  const std::vector<double>& peak_forces() const noexcept { return peaks_.forces(); }
  std::string FullReport() const override;

 private:
  struct Hand {
    vmech::GraspFrame named;  // where the hand takes hold by name
    ClosingHand closing;
    MovingFrame at;
    bool seen = false, holds = true;
    double worked = 0;          // by the coupling on the mechanism [J]
    double stored = 0;          // of the mechanism, when it was last held [J]
    double paid_when_held = 0;  // P of EnergyShares, then [J]
  };

  void TakeHand(const TickInput& input, int i) noexcept;
  void ReadHand(const TickInput& input, Hand* hand) noexcept;
  CoupledStatus Move() noexcept;
  void ShareEnergy(std::span<const TickInput> inputs) noexcept;
  /// What a step has lost and a later one gives back is no debt of the hand's in between.
  double EnergyOfHands() const noexcept {
    return dynamics_.Energy() + dynamics_.RememberedLosses() - dynamics_.design_work();
  }
  double StoredEnergy(bool held, int i) noexcept;
  void Account(CoupledStatus status, std::span<double> channels) noexcept;

  const KinematicTree& tree_;
  CoupledTickOptions options_;
  CoupledDynamics dynamics_;
  double period_;
  std::vector<Hand> hands_;
  EnergyShares shares_;
  std::vector<double> paid_, weights_;  // for these
  std::vector<Frame> frames_;           // the grasp frames before a step
  PeakForces peaks_;
  CoupledSummary summary_;
};

}  // namespace vmech
