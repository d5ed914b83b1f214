#pragma once

#include <memory>

#include "vmech/hw_interface/masters/master.h"

namespace vmech {

/// How the motion of a handle is carried over to the mechanism.
struct WorkspaceOptions {
  /// Motion at the mechanism over motion of the handle, in [0.01, 100]; rotations stay as they are.
  double motion_scale = 1;
  /// The button that is the clutch, as a bit of MasterState::buttons in [0, 31]; -1: there is none.
  int clutch = -1;
  /// What is known of the handle better than by the device: figures that are not zero, and a speed
  /// that is finite, stand for its own. No peak above the device's.
  HandlePhysics known;
  /// Fastest fall of the force when the clutch is pressed [N/s], in [10, 1e6].
  double release_rate = 1000;

  /// @throws std::invalid_argument naming field, value and range.
  void Validate() const;
  /// Is a device already all that these ask for?
  bool AsItIs() const noexcept;
};

/// Another master in a workspace of the user's choice, and with what the user knows of it. It is a
/// device like any other, whose physics are those of the real one seen through the scale s,
///
///   p = s p',  f = f'/s,  m = m'/s^2,  b = b'/s^2   (with a prime: of the real one),
///
/// so that power and energy are the same on both sides, and whatever bounds gains, forces and
/// energy for a device does so for this one.
///
/// While the clutch is pressed the handle moves alone: the hand stands still for the mechanism and
/// counts as let go (the dead-man switch), the last force falls at `release_rate`. Released, the
/// clutch takes hold where the hand stood, and the force comes back by the safety filter's ramp.
class WorkspaceMaster : public Master {
 public:
  /// `device` may be configured already. @throws std::invalid_argument as Validate.
  WorkspaceMaster(const WorkspaceOptions& options, std::unique_ptr<Master> device);
  ~WorkspaceMaster() override { Shutdown(); }

 private:
  DeviceInfo OnConfigure() override;
  void OnActivate() override { device_->Activate(); }
  void OnDeactivate() noexcept override { device_->Deactivate(); }
  void OnRecover() override { device_->Recover(); }
  void OnShutdown() noexcept override { device_->Shutdown(); }
  IoStatus OnRead(std::int64_t now_ns, MasterState* state) noexcept override;
  IoStatus OnWrite(const MasterCommand& command) noexcept override;
  Posed Placed(const Posed& X_DH) const noexcept;
  void TakeHoldAt(const Posed& X_DH) noexcept;
  void Fade(MasterCommand* command) noexcept;

  WorkspaceOptions options_;
  std::unique_ptr<Master> device_;
  MasterState sample_;  // of the device
  bool has_pose_ = false, clutched_ = false;
  Posed real_, placed_;  // where the handle was taken hold of, and where the mechanism has it
  Posed shown_;          // the last pose that was shown
  Vector6d last_F_Ho_D_ = Vector6d::Zero();  // at the device
};

}  // namespace vmech
