#pragma once

#include "vmech/base/linear_algebra/saddle_system.h"
#include "vmech/dynamics/in_hand/grasped_mechanism.h"

namespace vmech {

/// From the velocities of a step to the pose at its end, where the loops are closed.
class ClosingStep {
 public:
  ClosingStep(const KinematicTree& tree, const GraspedMechanism& pose);  ///< keeps references

  /// Where the step leads, q+ = q (+) T v+, and from there chord steps C dq = e2 with the factor in
  /// `system`. The first goes along with the step. `d` = -T C' v is what the velocities v+ of the
  /// step make up for. False where the loops do not close; `pose` is at q+.
  bool Close(const VectorXd& q, const VectorXd& v, const VectorXd& next_v, const VectorXd& d,
             double step, SaddleSystem* system, GraspedMechanism* pose, VectorXd* next_q) noexcept;
  /// Closes the loops, whose errors at q are in `pose`, with the factor in `system`, as when the
  /// mechanism itself has changed. False where they do not close; `pose` is at next_q.
  bool Reclose(const VectorXd& q, SaddleSystem* system, GraspedMechanism* pose,
               VectorXd* next_q) noexcept;
  /// Forgets how the last step went.
  void Restart() noexcept { last_closure_defect_.setZero(); }
  double closure() const noexcept;  ///< norm of the loop errors, lengths over L

 private:
  void Predict(const VectorXd& v, const VectorXd& next_v, const VectorXd& d, double step,
               SaddleSystem* system, GraspedMechanism* pose) noexcept;

  const KinematicTree& tree_;
  VectorXd x_, correction_, zero_;
  VectorXd predicted_defect_, last_closure_defect_;  // of the loops
  double squared_closure_ = 0;
};

}  // namespace vmech
