#pragma once

#include <array>
#include <cstdint>

#include "vmech/base/pose.h"
#include "vmech/base/screw.h"
#include "vmech/dynamics/in_hand/wrench_limit.h"
#include "vmech/hw_interface/masters/device_info.h"

namespace vmech {

/// How far a master is set up, and what may come next.
enum class Lifecycle : std::uint8_t {
  kUnconfigured,  ///< nothing is known; next: Configure
  kInactive,      ///< the link is up, states can be read, motors are off; next: Activate
  kActive,        ///< commands reach the motors
  kFault,         ///< motors are off until Recover
  kFinalized,     ///< after Shutdown; nothing more can be done
};

/// What came of reading a device, or of commanding it.
enum class IoStatus : std::uint8_t {
  kOk,
  kNoNewData,    ///< the state is that of the last read
  kLinkLost,     ///< nothing heard for longer than the device's hold time
  kDeviceFault,  ///< the device has switched its motors off; see Recover
  kRefused,      ///< a command of a mode that the device does not take; nothing was sent
};

/// What a command asks of the motors.
enum class CommandMode : std::uint8_t { kZero, kWrench, kJointTorque };

/// A sample. Fixed size, plain: it is copied to recordings and over the wire as it is.
struct MasterState {
  std::uint64_t sequence = 0;       ///< of the sample; grows by one per device period
  std::int64_t device_time_ns = 0;  ///< the device's clock at the sample
  std::int64_t host_time_ns = 0;    ///< the caller's clock at the read
  std::uint32_t valid = 0;          ///< bits of Sense
  std::uint32_t buttons = 0;        ///< bit by bit, pressed
  bool dead_man = false;            ///< held by the hand; true where there is no such switch
  bool emergency_stop = false;      ///< pressed
  /// Sequence of the command at work during the period before this sample; 0 if there was none.
  std::uint64_t command_echo = 0;
  Posed X_DH;                        ///< measured pose of the handle
  Vector6d V_DH = Vector6d::Zero();  ///< [v; w] of Ho and H, axes of D
  /// What the device exerted on the hand during the period before this sample.
  Vector6d applied_F_Ho_D = Vector6d::Zero();  ///< [f; m] about Ho, axes of D [N, N m]
  std::array<double, kMaxArmJoints> q{};       ///< measured joint coordinates [rad] or [m]
  double gripper_opening = 0;                  ///< [rad], zero is closed
};

/// What the motors are to do until the next command.
struct MasterCommand {
  std::uint64_t sequence = 0;             ///< grows by one per command
  CommandMode mode = CommandMode::kZero;  ///< which of the following counts
  /// The device goes to zero by itself after this time of the host's clock.
  std::int64_t valid_until_ns = std::numeric_limits<std::int64_t>::max();
  Vector6d F_Ho_D = Vector6d::Zero();  ///< kWrench; with kJointTorque: what the torques amount to
  std::array<double, kMaxArmJoints> torque{};  ///< kJointTorque [N m] or [N], without gravity's
  double gripper_torque = 0;                   ///< opens the gripper [N m]
};

/// A master is the device in the operator's hand. Frames: D its base, H its handle. A wrench is
/// always what the device exerts on the hand, [f; m], about Ho, in the axes of D; its power is
/// F_Ho_D . V_DH, positive when the device drives the hand.
///
/// This class is the base of all masters. It owns the life cycle, the same for each:
///
///   unconfigured -Configure-> inactive -Activate-> active -Deactivate-> inactive
///   fault -Recover-> inactive;  any -Shutdown-> finalized
///
/// Outside `active` every command is replaced by zero before it reaches the driver. Read and Write
/// are for the kHz loop: no heap, lock, log or exception. A driver implements the On... functions
/// and calls Shutdown in its destructor.
class Master {
 public:
  Master() = default;
  Master(const Master&) = delete;
  Master& operator=(const Master&) = delete;
  virtual ~Master() = default;

  /// Opens the link and asks the device what it is. @throws std::runtime_error if it cannot be had,
  /// std::logic_error if its physics is impossible or the life cycle forbids it (so do the others).
  void Configure();
  void Activate();             ///< motors on; the force is zero until the first Write
  void Deactivate() noexcept;  ///< motors off
  void Recover();              ///< from a fault back to inactive
  void Shutdown() noexcept;    ///< motors off, link closed; from any state

  /// The newest sample at time `now_ns` of the caller's monotonic clock. A simulated master
  /// advances its simulation to it. A sample without a pose, or without the joints of a device that
  /// senses them, is no new data: its switches count, everything else stays that of the last read.
  [[nodiscard]] IoStatus Read(std::int64_t now_ns, MasterState* state) noexcept;
  /// Gives the motors a command, which holds until its valid_until_ns or the next one.
  [[nodiscard]] IoStatus Write(const MasterCommand& command) noexcept;

  /// The hand in D in the last sample, where that is known better than the sample tells: by a
  /// recording of what an observer knew. Null: it is not.
  virtual const MovingFrame* ObservedHand() const noexcept { return nullptr; }
  /// What the device could exert at the posture of the last sample, where that is known to a
  /// recording; no limit otherwise.
  virtual WrenchLimit Room() const noexcept { return {}; }

  Lifecycle lifecycle() const noexcept { return lifecycle_; }  ///< which calls are allowed now
  /// Valid from Configure on.
  const DeviceInfo& info() const noexcept { return info_; }

 private:
  virtual DeviceInfo OnConfigure() = 0;
  virtual void OnActivate() {}
  virtual void OnDeactivate() noexcept {}
  virtual void OnRecover() {}
  virtual void OnShutdown() noexcept {}
  virtual IoStatus OnRead(std::int64_t now_ns, MasterState* state) noexcept = 0;
  virtual IoStatus OnWrite(const MasterCommand& command) noexcept = 0;
  void Require(Lifecycle wanted, const char* verb) const;
  IoStatus WithPose(IoStatus status, MasterState* state) noexcept;

  Lifecycle lifecycle_ = Lifecycle::kUnconfigured;
  DeviceInfo info_;
  MasterState last_;  // with a pose
};

/// Device periods from one sample to a later one, at least 1: what their sequence numbers say, and
/// no more than the host's clock leaves room for. A sample may be eight periods late.
double PeriodsBetween(const MasterState& earlier, const MasterState& later, double period) noexcept;

/// "active", "fault", ...
const char* NameOf(Lifecycle lifecycle) noexcept;
/// "ok", "link lost", ...
const char* NameOf(IoStatus status) noexcept;

}  // namespace vmech
