#include "vmech/hw_interface/arm_torques.h"

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
      velocity_(arm_.joints(), AdaptiveWindow(period, std::max(resolution, 1e-9))),
      posture_torque_(VectorXd::Zero(arm_.joints())),
      torque_(posture_torque_),
      M_inverse_Jt_(MatrixXd::Zero(arm_.joints(), 6)),
      factor_(arm_.joints()) {
  options.Validate();
}

void ArmTorques::Reset() noexcept {
  for (AdaptiveWindow& window : velocity_) window.Reset();
  posture_torque_.setZero();
}

void ArmTorques::Resolve(const MasterState& state, bool fresh, MasterCommand* command) noexcept {
  arm_.SetPosture(state.q.data());
  const VectorXd& q_0 = arm_.description().posture;
  for (int i = 0; fresh && i < arm_.joints(); ++i) {
    const double v = velocity_[i].Update(state.q[i]).v;
    posture_torque_[i] = options_.stiffness * (q_0[i] - state.q[i]) - options_.damping * v;
  }
  factor_.compute(arm_.MassMatrix());
  M_inverse_Jt_ = arm_.J().transpose();
  factor_.solveInPlace(M_inverse_Jt_);
  yielding_.noalias() = arm_.J() * M_inverse_Jt_;
  // At a singular posture nothing resists in some direction; a share of 1e-9 there is harmless.
  yielding_.diagonal().array() += 1e-9 * yielding_.trace();
  // What tau_p would do at the handle: Jbar' tau_p = (J M^-1 J')^-1 J M^-1 tau_p.
  Vector6d felt = M_inverse_Jt_.transpose() * posture_torque_;
  yielding_.llt().solveInPlace(felt);
  torque_ = posture_torque_;
  torque_.noalias() += arm_.J().transpose() * (command->F_Ho_D - felt);
  for (int i = 0; i < arm_.joints(); ++i) command->torque[i] = torque_[i];
}

}  // namespace vmech
