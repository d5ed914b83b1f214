#include "vmech/hw_interface/loop/arm_torques.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "vmech/base/check_range.h"
#include "vmech/base/screw_algebra.h"

namespace vmech {

void PostureOptions::Validate() const {
  CheckRange("PostureOptions", "stiffness", stiffness, 0, 100);
  CheckRange("PostureOptions", "damping", damping, 0, 10);
}

ArmTorques::ArmTorques(const PostureOptions& options, std::shared_ptr<const ArmDescription> arm,
                       double period, double resolution)
    : options_(options),
      arm_(std::move(arm)),
      posture_(JointArray::Zero()),
      velocity_(period, std::max(resolution, 1e-9)),
      null_space_(arm_.joints()),
      found_at_(JointArray::Constant(std::numeric_limits<double>::infinity())),
      room_at_(found_at_) {
  options.Validate();
  posture_.head(arm_.joints()) = arm_.description().posture;
  motions_.fill(JointArray::Zero());
  drives_.fill(JointArray::Zero());
}

void ArmTorques::Reset() noexcept {
  velocity_.Reset();
  posture_torque_.setZero();
}

void ArmTorques::Resolve(const MasterState& state, bool fresh,
                         MasterCommand* command) noexcept VMECH_NONBLOCKING {
  constexpr double kSamePosture = 3e-3, kSameRoom = 0.01;  // [rad], [m]
  const Eigen::Map<const JointArray> q(state.q.data());
  arm_.SetPosture(q.data());
  if (!((q - found_at_).abs().maxCoeff() < kSamePosture)) {
    FindFreeMotions();
    found_at_ = q;
  }
  if (!((q - room_at_).abs().maxCoeff() < kSameRoom)) {
    torque_room_ = arm_.TorqueRoom();
    room_ = arm_.WrenchRoom(torque_room_);
    room_at_ = q;
  }
  if (fresh) {
    posture_torque_ =
        options_.stiffness * (posture_ - q) - options_.damping * velocity_.Update(q).v;
  }
  const Screw F_Do = arm_.WrenchAtBase(command->F_Ho_D);
  for (int i = 0; i < arm_.joints(); ++i) torque_[i] = Power(F_Do, arm_.S()[i]);
  JointArray unfelt = JointArray::Zero();
  for (int k = 0; k < free_motions_; ++k) {
    unfelt += (motions_[k] * posture_torque_).sum() * drives_[k];
  }
  torque_ += ShareOf(unfelt) * unfelt;
  Eigen::Map<JointArray>(command->torque.data()) = torque_;
}

/// The posture takes of the motors no more than the wrench leaves.
double ArmTorques::ShareOf(const JointArray& unfelt) const noexcept {
  double share = 1;
  for (int i = 0; i < arm_.joints(); ++i) {
    const double left = torque_room_[i] - std::copysign(1.0, unfelt[i]) * torque_[i];
    if (std::abs(unfelt[i]) > left)
      share = std::min(share, std::max(0.0, left) / std::abs(unfelt[i]));
  }
  return share;
}

void ArmTorques::FindFreeMotions() noexcept {
  free_motions_ = null_space_.Find(arm_.S(), &motions_);
  for (int k = 0; k < free_motions_; ++k) {
    JointArray &n = motions_[k], &drive = drives_[k];
    for (int i = 0; i < k; ++i) n -= (drives_[i] * n).sum() * motions_[i];
    arm_.Momenta(n.data(), drive.data());
    drive /= (n * drive).sum();
  }
}

}  // namespace vmech
