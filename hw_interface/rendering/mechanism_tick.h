#pragma once

#include <limits>

#include "vmech/dynamics/in_hand/hand_dynamics.h"
#include "vmech/hw_interface/estimation/coordinate_estimator.h"
#include "vmech/hw_interface/rendering/contact_law.h"
#include "vmech/hw_interface/rendering/peak_forces.h"
#include "vmech/hw_interface/rendering/tick.h"
#include "vmech/kinematics/inverse/hand_tracker.h"

namespace vmech {

/// What a MechanismTick renders of a mechanism that follows the hand.
struct MechanismTickOptions {
  /// The constraint as the hand feels it, stiffness in [0, 1e7], damping in [0, 1e5], losses in
  /// [0, 1e3]; the stiffness is also the metric in which the mechanism follows the hand.
  ContactLaw law;
  /// Force at the hand over force at the mechanism, in [1e-6, 1e3]: 0.1 makes it ten times as
  /// light.
  double scale = 1;
  /// Largest share of the mechanism's inertia that the hand feels, in [0, 1]. Weight, springs and
  /// friction are felt whole.
  double inertia = 1;
  /// Largest inertia that is felt over the handle's masses D [-], in [1e-6, 1e6]: the share
  /// falls where the pose makes the mechanism heavier. Raise it for a truer inertia, lower it for a
  /// device that hums. D = 0: no limit.
  double inertia_ratio = 1e6;
  Vector6d handle_masses = Vector6d::Zero();  ///< D, diagonal [kg, kg m^2], each in [0, 1e6]
  /// Roll-off of the acceleration [s], in [0, 0.1]: longer renders heavier mechanisms with less
  /// noise, and lags by as much. For estimators that find velocities alone.
  double roll_off = 8e-3;
  /// A hand that is faster than this is braked [m/s], [rad/s], > 0: what falls out of a hand with
  /// little inertia of its own would be stopped by the safety filter.
  double max_speed = std::numeric_limits<double>::infinity();
  double max_angular_speed = std::numeric_limits<double>::infinity();  ///< [rad/s], > 0
  /// Largest w_d as felt [N], [N m], > 0, those of the device: near a pose where the hand hardly
  /// moves the mechanism, what it takes has no bound.
  double max_force = std::numeric_limits<double>::infinity();
  double max_moment = std::numeric_limits<double>::infinity();  ///< [N m], > 0
  /// Fastest change of w_d [N/s], in [10, 1e7], and a tenth of it for moments [N m/s].
  double slew = 5e3;
  EstimatorOptions estimator;                 ///< of velocities and accelerations
  WrenchRule wrench = WrenchRule::kWorkless;  ///< workless, or as the paper prints it
  /// Its stiffness is set from the law. Two steps: the next tick goes on from there.
  TrackOptions track;

  MechanismTickOptions() { track.steps = 2; }
  /// By what the inertia lags behind the mechanism's velocity [s]: `roll_off`, or 0 where the
  /// estimator finds accelerations itself.
  double LagOfInertia() const;

  /// @throws std::invalid_argument naming field, value and range.
  void Validate() const;
};

/// The paper's tick (sections 4 to 6): the pose nearest to the hand, its velocity and acceleration,
/// what it takes to move the mechanism so, and the pull of the constraint,
///
///   q = argmin e1'K e1, e2 = 0;   F_Ho = -(s_F w_d + w_c),   s_F the scale.
///
/// From a hand whose twist is known (HandObserver), the velocity is that of the constrained
/// minimum, v = P V_H (HandDynamics), and the mechanism's inertia goes with a velocity u that lags
/// behind it,
///
///   u' = (v - u) / t,   w_d = P'(M u' + c(q, u) + weight ..),
///
/// an acceleration with a roll-off of first order at 1/(2 pi t), which needs no second difference
/// of an encoder. The inertia felt is that of s M, s = min(s_max, R / ratio(q)) the share that the
/// device can render at this pose, and as s changes, s^1/2 u is what keeps its momentum: a
/// mechanism of that inertia, which gives no energy away. A hand that has stayed within the
/// device's resolution for 0.2 s is at rest: the steps of its encoders are no motion. The other
/// estimators take the steps of q itself, as the paper does. No allocation after construction.
class MechanismTick : public Tick {
 public:
  /// Keeps a reference to the tree. `q`: a closed pose, where the hand takes hold. `device` states
  /// the period and the resolution of the hand's pose.
  /// @throws std::invalid_argument as Validate, HandTracker and HandDynamics.
  MechanismTick(const KinematicTree& tree, int grasp, const VectorXd& q, const DeviceInfo& device,
                const MechanismTickOptions& options);

  std::vector<std::string> ChannelNames() const override;
  std::vector<std::string> StateNames() const override;
  Posed GraspFrame() const noexcept override { return X_WG_; }
  void Reset() noexcept override;
  bool UsesObservedHand() const noexcept override {
    return options_.estimator.kind == EstimatorKind::kObserver;
  }
  TickOutput Step(const TickInput& input, std::span<double> channels) noexcept override;

  void Show(TickPicture* picture) const noexcept override;

  /// [nq], the pose that follows the hand
  const VectorXd& q() const noexcept { return tracker_.q(); }
  const HandDynamics& dynamics() const noexcept { return dynamics_; }  ///< of the last tick
  /// Since the hand took hold.
  const TrackSummary& tracking() const noexcept { return tracker_.summary(); }
  double share() const noexcept { return share_; }  ///< s of the last tick
  /// Largest force of each joint since the hand took hold [N].
  const std::vector<double>& peak_forces() const noexcept { return peaks_.forces(); }
  std::string FullReport() const override;

 private:
  Vector6d ReadHand(const TickInput& input, int periods) noexcept;
  bool FindMotion(int periods) noexcept;
  void FindShare(double elapsed) noexcept;
  void FindRest(double elapsed) noexcept;
  double Moving() const noexcept;
  void RollOff(const VectorXd& v, double elapsed) noexcept;
  void Estimate(int periods) noexcept;
  void FindFeltMotion(double elapsed) noexcept;
  Vector6d Brake() const noexcept;
  void Feel(int periods, const Vector6d& charged, const Vector6d& way) noexcept;
  void AccountForEnergy(double elapsed, double given, double energy) noexcept;
  void FollowWrench(double elapsed) noexcept;
  void Report(std::span<double> channels) noexcept;

  const KinematicTree& tree_;
  MechanismTickOptions options_;
  HandTracker tracker_;
  HandDynamics dynamics_;
  double period_;
  bool has_hand_ = false, starts_ = true;
  Posed X_WH_, X_WG_;
  Vector6d V_WH_ = Vector6d::Zero();
  double resolution_, angular_resolution_;
  Posed X_rest_;                     // where the hand may be at rest
  double resting_ = 0;               // since when [s]
  CoordinateEstimator hand_;         // of a hand that nobody observes
  CoordinateEstimator coordinates_;  // of q
  VectorXd hand_step_, q_step_, last_q_;
  TrackStatus track_ = TrackStatus::kNotRun;
  MatrixXd S_;
  VectorXd v_, u_, udot_;      // of the nearest pose; of its inertia
  VectorXd felt_, felt_rate_;  // s^1/2 u, and s^1/2 times its rate
  double share_ = 0, last_root_ = 0, least_share_ = 1;
  Vector6d e1_ = Vector6d::Zero();
  Vector6d w_d_ = Vector6d::Zero();                  // as felt
  Vector6d w_c_ = Vector6d::Zero();                  // the pull of the constraint
  Vector6d F_Ho_ = Vector6d::Zero();                 // what the hand was to feel last
  double energy_ = 0, unpaid_ = 0, mean_given_ = 0;  // of mechanism and constraint as felt [J]
  PeakForces peaks_;
};

}  // namespace vmech
