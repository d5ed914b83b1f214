#include "vmech/hw_interface/arm_torques.h"

#include <algorithm>

#include "vmech/kinematics/screw_algebra.h"
#include "vmech/solvers/stopping_rule.h"

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
      null_space_(arm_.joints()) {
  options.Validate();
  posture_.head(arm_.joints()) = arm_.description().posture;
  motions_.fill(JointArray::Zero());
  momenta_.fill(JointArray::Zero());
}

void ArmTorques::Reset() noexcept {
  velocity_.Reset();
  posture_torque_.setZero();
}

void ArmTorques::Resolve(const MasterState& state, bool fresh,
                         MasterCommand* command) noexcept VMECH_NONBLOCKING {
  arm_.SetPosture(state.q.data());
  if (fresh) {
    const JointArray q = Eigen::Map<const JointArray>(state.q.data());
    posture_torque_ =
        options_.stiffness * (posture_ - q) - options_.damping * velocity_.Update(q).v;
  }
  const Screw F_Do = arm_.WrenchAtBase(command->F_Ho_D);
  for (int i = 0; i < arm_.joints(); ++i) torque_[i] = Power(F_Do, arm_.S()[i]);
  const int count = null_space_.Find(arm_.S(), &motions_);
  for (int k = 0; k < count; ++k) {
    JointArray &n_k = motions_[k], &p_k = momenta_[k];
    for (int i = 0; i < k; ++i) {
      const JointArray &n_i = motions_[i], &p_i = momenta_[i];
      n_k -= n_i * ((p_i * n_k).sum() / (p_i * n_i).sum());
    }
    arm_.Momenta(n_k.data(), p_k.data());
    torque_ += p_k * ((n_k * posture_torque_).sum() / (n_k * p_k).sum());
  }
  Eigen::Map<JointArray>(command->torque.data()) = torque_;
}

}  // namespace vmech
