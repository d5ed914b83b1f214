#include "vmech/hw_interface/masters/workspace_master.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "vmech/base/check_range.h"

namespace vmech {
namespace {

/// A handle as it is felt where motions are s times as large.
HandlePhysics Seen(HandlePhysics handle, double s) {
  handle.mass /= s * s;
  handle.damping /= s * s;
  handle.coulomb /= s;
  handle.resolution *= s;
  handle.peak /= s;
  handle.max_speed *= s;
  return handle;
}

/// The device's figures, but for those that are known better.
HandlePhysics Corrected(HandlePhysics handle, const HandlePhysics& known) {
  const auto take = [](double* stated, double better) {
    if (better != 0) *stated = better;
  };
  const double peak = handle.peak;
  take(&handle.mass, known.mass);
  take(&handle.damping, known.damping);
  take(&handle.coulomb, known.coulomb);
  take(&handle.resolution, known.resolution);
  take(&handle.peak, known.peak);
  if (peak > 0) handle.peak = std::min(handle.peak, peak);
  handle.max_speed = std::min(handle.max_speed, known.max_speed);
  return handle;
}

}  // namespace

bool WorkspaceOptions::AsItIs() const noexcept {
  const bool nothing_known = known.mass == 0 && known.damping == 0 && known.coulomb == 0 &&
                             known.resolution == 0 && known.peak == 0 &&
                             std::isinf(known.max_speed);
  return motion_scale == 1 && clutch < 0 && nothing_known;
}

void WorkspaceOptions::Validate() const {
  CheckRange("WorkspaceOptions", "motion_scale", motion_scale, 0.01, 100);
  CheckRange("WorkspaceOptions", "clutch", clutch, -1, 31);
  CheckRange("WorkspaceOptions", "release_rate", release_rate, 10, 1e6);
}

WorkspaceMaster::WorkspaceMaster(const WorkspaceOptions& options, std::unique_ptr<Master> device)
    : options_(options), device_(std::move(device)) {
  options_.Validate();
}

DeviceInfo WorkspaceMaster::OnConfigure() {
  if (device_->lifecycle() == Lifecycle::kUnconfigured) device_->Configure();
  DeviceInfo info = device_->info();
  info.linear = Seen(Corrected(info.linear, options_.known), options_.motion_scale);
  info.has_dead_man = info.has_dead_man || options_.clutch >= 0;
  // Joint coordinates, and torques from them, are those of the handle where it really is.
  info.takes_torque = false;
  info.arm = nullptr;
  info.senses &= ~static_cast<std::uint32_t>(kSensesJoints);
  return info;
}

void WorkspaceMaster::TakeHoldAt(const Posed& X_DH) noexcept {
  placed_ = has_pose_ ? shown_ : Posed{X_DH.R, options_.motion_scale * X_DH.p};
  real_ = X_DH;
  has_pose_ = true;
}

/// The handle's way since it was taken hold of, from where that was for the mechanism.
Posed WorkspaceMaster::Placed(const Posed& X_DH) const noexcept {
  Posed X;
  X.p = placed_.p + options_.motion_scale * (X_DH.p - real_.p);
  X.R = X_DH.R * real_.R.transpose() * placed_.R;
  return X;
}

IoStatus WorkspaceMaster::OnRead(std::int64_t now_ns, MasterState* state) noexcept {
  const IoStatus io = device_->Read(now_ns, &sample_);  // it may leave the last sample as it is
  *state = sample_;
  state->valid &= ~static_cast<std::uint32_t>(kSensesJoints);
  if ((sample_.valid & kSensesPose) == 0) return io;
  const bool pressed = options_.clutch >= 0 && ((sample_.buttons >> options_.clutch) & 1u) != 0;
  if (!has_pose_ || (clutched_ && !pressed)) TakeHoldAt(sample_.X_DH);
  clutched_ = pressed;
  if (!clutched_) shown_ = Placed(sample_.X_DH);
  state->X_DH = shown_;
  if (clutched_) {
    state->dead_man = false;
    state->V_DH.setZero();
    state->applied_F_Ho_D.setZero();
  }
  state->V_DH.head<3>() *= options_.motion_scale;
  state->applied_F_Ho_D.head<3>() /= options_.motion_scale;
  return io;
}

IoStatus WorkspaceMaster::OnWrite(const MasterCommand& command) noexcept {
  MasterCommand real = command;
  real.F_Ho_D.head<3>() *= options_.motion_scale;
  const bool acts = lifecycle() == Lifecycle::kActive;
  const bool by_clutch = clutched_ && sample_.dead_man && !sample_.emergency_stop;
  if (acts && by_clutch) Fade(&real);
  last_F_Ho_D_ = acts && real.mode == CommandMode::kWrench ? real.F_Ho_D : Vector6d::Zero().eval();
  return device_->Write(real);
}

/// What is left of the last wrench, instead of nothing at once.
void WorkspaceMaster::Fade(MasterCommand* command) noexcept {
  const double fall = options_.release_rate * info().period;
  const double force = last_F_Ho_D_.head<3>().norm();
  if (command->mode != CommandMode::kZero || force <= fall) return;
  command->mode = CommandMode::kWrench;
  command->F_Ho_D = (1 - fall / force) * last_F_Ho_D_;
}

}  // namespace vmech
