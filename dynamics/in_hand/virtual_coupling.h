#pragma once

#include <limits>

#include "vmech/dynamics/in_hand/grasped_mechanism.h"
#include "vmech/dynamics/in_hand/wrench_limit.h"

namespace vmech {

/// Spring and damper between a hand and the grasp frame, diagonal, world axes. Beyond the largest
/// force and moment the spring slips along, in its direction: the mechanism never gets more than
/// the device can give the hand.
struct HandCoupling {
  Vector6d stiffness = Vector6d::Zero();  ///< K [N/m], [N m/rad], each in [0, 1e9]
  Vector6d damping = Vector6d::Zero();    ///< B [N s/m], [N m s/rad], each in [0, 1e7]
  double max_force = std::numeric_limits<double>::infinity();   ///< largest force [N], >= 1e-9
  double max_moment = std::numeric_limits<double>::infinity();  ///< largest moment [N m], >= 1e-9
};

/// A HandCoupling at work, taken at the end of steps of T:
///
///   w = | |K (e1 - T V_G)| + B (V_H - V_G) |,
///
/// e1 the hand's error at the start, V_H and V_G the twists of hand and grasp at the end, bars for
/// what is shortened to the largest force and moment: a spring that slips pulls no harder, and what
/// comes back to the hand meanwhile is braked by the whole damper before the spring takes hold.
class VirtualCoupling {
 public:
  /// Rotational rows do not count for a point grasp. @throws std::invalid_argument if a gain is out
  /// of range.
  VirtualCoupling(const HandCoupling& coupling, GraspKind kind, double step);

  /// Takes where the grasp frame and the hand are, in the world: e1 is then what is between them.
  void Stretch(const Frame& X_WG, const MovingFrame& hand) noexcept;

  /// What the device can exert at this moment, beside the largest force and moment of the coupling
  /// itself. A spring that slips does not pull harder because there is more room, until it has
  /// stopped: its energy would grow by what nobody pays.
  void Within(const WrenchLimit& room) noexcept { room_ = room; }

  const Screw& stiffness() const noexcept { return stiffness_; }  ///< K
  /// Before a step, with the grasp's twist as it is: a spring that has slipped goes on with it if
  /// it will be too long.
  void Foresee(const Screw& V_WG) noexcept;
  /// G^1/2, w = Given - G V_G: B + T K, of a spring that slips B, and nothing where w is given.
  Screw RootGain() const noexcept;
  Screw Given() const noexcept;  ///< what does not depend on the motion to come
  /// Finds w for the grasp's twist at the end of the step. True if spring or w turn out too large;
  /// then Given and RootGain are those of what slips from now on, until the next Stretch.
  bool Pull(const Screw& V_WG) noexcept;
  void LetGo() noexcept;  ///< nothing pulls until the next Pull

  /// [p; r] from the grasp frame to the hand, world axes [m, rad].
  const Screw& e1() const noexcept { return e1_; }
  /// The wrench of the hand on the mechanism about Go, world axes [N, N m].
  const Screw& w() const noexcept { return w_; }
  /// True while the wrench is the largest that is allowed: the spring then stretches no further.
  bool slipping() const noexcept { return slipping_; }
  double energy() const noexcept { return energy_; }  ///< of the spring [J]
  /// What the damper gave the mechanism in the step [J]; 0 where it took.
  double dragged() const noexcept { return dragged_; }

 private:
  WrenchLimit Allowed(const Screw& pull) const noexcept;
  bool PullSpring(const Screw& V_WG) noexcept;
  bool PullAll(const Screw& V_WG) noexcept;

  Screw stiffness_, damping_, root_gain_, root_damping_;
  WrenchLimit most_, room_;
  WrenchLimit slipped_;  // at what the spring slipped last; no limit where it did not
  double T_;
  Screw V_WH_, e1_, spring_, w_;
  double energy_ = 0, dragged_ = 0;
  // In this step: the spring's force and moment, and w itself, are given.
  bool force_slips_ = false, moment_slips_ = false, all_slips_ = false;
  bool slipping_ = false;
};

}  // namespace vmech
