#pragma once

#include "vmech/dynamics/in_hand/hand_dynamics.h"
#include "vmech/hw_interface/estimation/pose_estimator.h"
#include "vmech/hw_interface/rendering/contact_law.h"
#include "vmech/hw_interface/rendering/peak_forces.h"
#include "vmech/hw_interface/rendering/tick.h"
#include "vmech/kinematics/inverse/hand_tracker.h"

namespace vmech {

struct MechanismTickOptions {
  ContactLaw law;  ///< its stiffness is also the metric in which the mechanism follows the hand
  /// Share of the mechanism's inertia that the hand feels, in [0, 1]: what a measured acceleration
  /// renders. Lower it where the mechanism is heavier than the device (StableInertiaShare), or take
  /// CoupledTick.
  double inertia = 1;
  PoseEstimatorOptions estimator;
  /// Its stiffness is set from the law. Two steps: the next tick goes on from there.
  TrackOptions track;

  MechanismTickOptions() { track.steps = 2; }

  /// @throws std::invalid_argument naming field, value and range.
  void Validate() const;
};

/// The paper's tick (sections 4 to 6): the pose nearest to the hand, its velocity and acceleration,
/// what it takes to move the mechanism so, and the pull of the constraint,
///
///   q = argmin e1'K e1, e2 = 0;   V_G, A_G from the poses of G;   F_Ho = -(w_d + w_c).
///
/// Velocities are those of the grasp frame on the mechanism, so that they and the loops agree; the
/// damping of w_c takes the rate of e1 from an adaptive window. No allocation after construction.
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
  TickOutput Step(const TickInput& input, std::span<double> channels) noexcept override;

  void Show(TickPicture* picture) const noexcept override;

  const VectorXd& q() const noexcept { return tracker_.q(); }
  const HandDynamics& dynamics() const noexcept { return dynamics_; }
  const TrackSummary& tracking() const noexcept { return tracker_.summary(); }
  /// Largest force of each joint since the hand took hold [N].
  const std::vector<double>& peak_forces() const noexcept { return peaks_.forces(); }
  std::string FullReport() const override;

 private:
  void Report(const Vector6d& e1, std::span<double> channels) noexcept;

  MechanismTickOptions options_;
  HandTracker tracker_;
  HandDynamics dynamics_;
  PoseEstimator motion_;
  std::array<AdaptiveWindow, 6> slip_;
  Vector6d slip_rate_ = Vector6d::Zero();
  TrackStatus track_ = TrackStatus::kNotRun;
  double period_;
  Posed X_WH_, X_WG_;
  Vector6d w_c_ = Vector6d::Zero();  // the pull of the constraint
  PeakForces peaks_;
};

}  // namespace vmech
