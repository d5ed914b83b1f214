#pragma once

#include <array>

#include "vmech/base/nonblocking.h"
#include "vmech/hw_interface/arm/arm_model.h"
#include "vmech/hw_interface/arm/handle_null_space.h"
#include "vmech/hw_interface/estimation/estimators.h"
#include "vmech/hw_interface/masters/master.h"

namespace vmech {

/// How the freedoms of an arm that the hand does not feel are held.
struct PostureOptions {
  double stiffness = 2;  ///< towards the nominal posture [N m/rad], in [0, 100]
  double damping = 0.3;  ///< of motion that the hand does not feel [N m s/rad], in [0, 10]

  /// @throws std::invalid_argument naming field, value and range.
  void Validate() const;
};

/// Joint torques of an arm for a wrench at the handle (paper eq. 12 with the sign of F on the
/// hand), and a torque towards the nominal posture in the null space of a redundant arm:
///
///   tau = J' F_Ho + sum_k M n_k (n_k' tau_p) / (n_k' M n_k),   tau_p = k (q_0 - q) - d v,
///
/// n_k a basis of the null space of J, orthogonal in the metric M. The sum is what the dynamically
/// consistent inverse Jbar = M^-1 J' (J M^-1 J')^-1 [Khatib 1987] leaves of tau_p, (1 - J' Jbar')
/// tau_p: it does not accelerate the handle, since J M^-1 M n_k = 0. The n_k hold until a joint has
/// moved by 3e-3 rad or m, and the handle gets no more than about that part of tau_p. Joint
/// velocities come from Kalman filters. No allocation after construction.
class ArmTorques {
 public:
  /// `resolution` of the encoders [rad]. @throws as Validate and ArmModel.
  ArmTorques(const PostureOptions& options, std::shared_ptr<const ArmDescription> arm,
             double period, double resolution);

  void Reset() noexcept;  ///< the next sample is the first
  /// Writes `torque` of the command from its F_Ho_D at measured angles; `fresh` as in TickInput.
  void Resolve(const MasterState& state, bool fresh,
               MasterCommand* command) noexcept VMECH_NONBLOCKING;
  /// What gravity leaves of the motors for the handle, at the posture of the last Resolve to 0.01
  /// rad; no limit before.
  const WrenchLimit& room() const noexcept { return room_; }

 private:
  void FindFreeMotions() noexcept;
  double ShareOf(const JointArray& unfelt) const noexcept;

  PostureOptions options_;
  ArmModel arm_;
  JointArray posture_;  // the nominal one
  KalmanEstimator<JointArray> velocity_;
  JointArray posture_torque_ = JointArray::Zero(), torque_ = JointArray::Zero();
  HandleNullSpace null_space_;
  JointArray found_at_, room_at_;                // q of the free motions, and of the room
  JointArray torque_room_ = JointArray::Zero();  // of each motor, beside gravity
  WrenchLimit room_;
  int free_motions_ = 0;
  std::array<JointArray, kMaxArmJoints> motions_, drives_;  // n_k and M n_k / (n_k' M n_k)
};

}  // namespace vmech
