#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "vmech/hw_interface/estimation/hand_observer.h"
#include "vmech/hw_interface/loop/arm_torques.h"
#include "vmech/hw_interface/recording/recording.h"
#include "vmech/hw_interface/rendering/registration.h"
#include "vmech/hw_interface/rendering/tick.h"
#include "vmech/hw_interface/safety/safety_filter.h"

namespace vmech {
/// How a loop treats a hand and its device.
struct HandLoopOptions {
  SafetyOptions safety;          ///< of the wrenches that are sent
  HandObserverOptions observer;  ///< where the device is an arm that states itself
  PostureOptions posture;        ///< of an arm with more joints than it needs
  bool gripper = false;          ///< hold only while the gripper is closed, where it is sensed
  bool joint_torques = true;     ///< where the device takes them; else wrenches
  bool uses_observed = false;    ///< the tick goes by what an observer knows
  int command_life = 5;          ///< periods after which the device drops a command by itself
  Matrix3d R_WD = Matrix3d::Identity();  ///< the device's axes in the mechanism's world
};

/// What came of a hand in a run; every figure was measured here.
struct HandSummary {
  std::string device;                      ///< by its name
  ForceOff cause = ForceOff::kNone;        ///< of a fault, or of a link that was lost
  std::uint64_t missed = 0;                ///< ticks without a new sample
  std::uint64_t grasps = 0;                ///< how often the hand took hold
  SafetyCounters safety;                   ///< how often the filter acted
  double peak_force = 0, peak_moment = 0;  ///< sent [N], [N m]
  double least_energy = 0;                 ///< of the passivity observer [J]

  std::string Report() const;  ///< lines
};

/// All that stands between a tick and one of the devices: sample, observer, registration, safety
/// filter, torques. A Runner has one for every hand. No allocation after construction.
class HandLoop {
 public:
  /// `master` must be configured and outlive this. @throws std::invalid_argument as SafetyFilter.
  HandLoop(const HandLoopOptions& options, Master* master);

  /// The device, in the slot that begins at `slot_ns`.
  void Read(std::int64_t slot_ns, bool emergency_stop, HandRecord* record) noexcept;
  /// A sample has come, now or before: the device is laid over the mechanism.
  bool registered() const noexcept { return registered_; }
  /// The first sample is here, and the hand is to be registered where the grasp frame is.
  bool arrives() const noexcept { return fresh_ && !registered_; }
  void Register(const Posed& X_WG) noexcept;  ///< lays the handle over it
  /// What the tick is told. `hand`: of the tick. The input refers to this.
  TickInput Prepare(int hand, Tick* tick, HandRecord* record) noexcept VMECH_NONBLOCKING;
  /// What the tick is told of a hand that has not come yet, or is lost.
  TickInput Absent() noexcept;
  /// What the tick wants, in the device's axes.
  void Take(const TickOutput& wanted, HandPicture* picture, HandRecord* record) const noexcept;
  /// Through the filter to the device.
  void Send(std::int64_t slot_ns, double stored_energy, HandRecord* record) noexcept;

  ForceOff latched() const noexcept {
    return safety_.latched();
  }  ///< why no force is sent any more
  /// Nothing is heard of the device any more: the hand has let go for good.
  bool lost() const noexcept { return latched() == ForceOff::kLinkLost; }
  Master& master() const noexcept { return *master_; }  ///< as given
  HandSummary Summary() const;                          ///< of the run so far

 private:
  void Observe() noexcept;
  std::optional<MovingFrame> ObservedHand() const noexcept;
  void TakeUpAgain(const Posed& X_WG) noexcept;
  bool GripperCloses() const noexcept;
  void GraspOrLetGo(int hand, Tick* tick) noexcept;

  HandLoopOptions options_;
  Master* master_;
  double period_;
  std::int64_t period_ns_;
  SafetyFilter safety_;
  std::unique_ptr<ArmTorques> torques_;
  std::unique_ptr<HandObserver> observer_;
  Registration registration_;
  MasterState state_, last_sample_;
  MovingFrame observed_;
  Vector6d charged_ = Vector6d::Zero();
  HandSummary summary_;
  bool registered_ = false, holds_ = false, fresh_ = false;
  int missing_ = 0, gap_ = 0;  // samples in a row: now, and before the last fresh one
};

}  // namespace vmech
