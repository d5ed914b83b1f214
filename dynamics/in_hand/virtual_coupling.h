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
///   w = K (e1 - T V_G) + B (V_H - V_G),
///
/// e1 the hand's error at the start, V_H and V_G the twists of hand and grasp at the end.
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
  const Screw& root_gain() const noexcept { return root_gain_; }  ///< (B + T K)^1/2
  /// K e1 + B V_H: what does not depend on the motion to come.
  Screw Given() const noexcept;
  /// Finds w for the grasp's twist at the end of the step. True if it is larger than it may be;
  /// then it is shortened to that.
  bool Pull(const Screw& V_WG) noexcept;
  void LetGo() noexcept;  ///< nothing pulls until the next Pull

  /// [p; r] from the grasp frame to the hand, world axes [m, rad].
  const Screw& e1() const noexcept { return e1_; }
  /// The wrench of the hand on the mechanism about Go, world axes [N, N m].
  const Screw& w() const noexcept { return w_; }
  /// True while the wrench is the largest that is allowed: the spring then stretches no further.
  bool slipping() const noexcept { return slipping_; }
  double energy() const noexcept { return energy_; }  ///< of the spring [J]
  /// The most that the damper can give the mechanism in a step at its twist [J].
  double Dragged(const Screw& V_WG) const noexcept;

 private:
  WrenchLimit Allowed(const Screw& pull) const noexcept;

  Screw stiffness_, damping_, root_gain_;
  WrenchLimit most_, room_;
  WrenchLimit slipped_;  // at what the spring slipped last; no limit where it did not
  double T_;
  Screw V_WH_, e1_, w_;
  double energy_ = 0;
  bool slipping_ = false;
};

}  // namespace vmech
