#pragma once

#include <algorithm>

#include "vmech/base/nonblocking.h"
#include "vmech/dynamics/in_hand/wrench_limit.h"
#include "vmech/hw_interface/masters/master.h"
#include "vmech/hw_interface/safety/passivity.h"

namespace vmech {

/// Why there is no force.
enum class ForceOff : std::uint8_t {
  kNone,
  kNotActive,      ///< the master is not active
  kDeadMan,        ///< the hand let go of the switch
  kStale,          ///< no new sample for longer than `hold_periods`
  kEmergencyStop,  ///< from here on latched until Unlatch
  kLinkLost,
  kDeviceFault,
  kNonFinite,  ///< a pose or a wrench that is not a number
  kSpeed,      ///< the handle moves faster than it may
  kEnergy,     ///< more energy was given than passivity can win back
};
/// "emergency stop", ...
const char* NameOf(ForceOff cause) noexcept;
/// What to do about a cause that trips, "" for the others: "render less with --scale, ...".
const char* AdviceFor(ForceOff cause) noexcept;

/// Stages that changed the wrench of a tick, as bits.
enum SafetyStage : std::uint32_t {
  kRamped = 1u << 0,
  kDamped = 1u << 1,
  kClamped = 1u << 2,
  kSlewed = 1u << 3,
  kBraked = 1u << 4,
};
/// How many stages there are.
inline constexpr int kSafetyStages = 5;

/// What the safety filter lets through to the motors.
struct SafetyOptions {
  double soft_start = 0.5;  ///< ramp from nothing to the whole wrench [s], in [0, 10]
  /// Count what the soft start withholds as carried by somebody else: for a mechanism that moves by
  /// itself and gets the whole from the start. False: the hand pays for what it feels only.
  bool carried_start = false;
  int hold_periods = 5;      ///< samples that may be missing before the force goes, in [0, 1000]
  double max_force = 0;      ///< [N], in [0, 1e4]; 0: the device's peak
  double max_moment = 0;     ///< [N m], in [0, 1e3]; 0: the device's peak
  double force_slew = 5e3;   ///< fastest change [N/s], in [1, 1e7]; lower is softer and lags
  double moment_slew = 250;  ///< [N m/s], in [0.1, 1e6]
  double max_speed = 0;      ///< trip [m/s], in [0, 100]; 0: the device's
  double max_angular_speed = 0;  ///< trip [rad/s], in [0, 1000]; 0: the device's
  double energy_trip = 0.2;      ///< debt that trips [J], in [1e-4, 100]
  PassivityOptions passivity;    ///< of the observer of energy

  /// @throws std::invalid_argument naming field, value and range.
  void Validate() const;
};

/// The same, with a force and a moment that change by no more than a tenth of the device's peak
/// from one tick to the next: what strikes a stop is felt as a push, not as a blow. The energy is
/// that of what was sent, so passivity holds; what is taken away goes within ten ticks.
SafetyOptions WithoutBlows(SafetyOptions safety, const DeviceInfo& device);

/// What the filter judges in a tick.
struct SafetyInput {
  Lifecycle lifecycle = Lifecycle::kUnconfigured;  ///< of the device, when it was read
  IoStatus io = IoStatus::kOk;                     ///< of the read
  const MasterState* state = nullptr;              ///< of the read
  Vector6d F_Ho_D = Vector6d::Zero();              ///< what the tick wants
  double stored_energy = 0;  ///< of the virtual mechanism [J]; see passivity.h
  WrenchLimit room = {};     ///< what the device can exert at this posture
};

/// What the safety filter made of a wrench.
struct SafetyOutput {
  std::uint64_t sequence = 0;  ///< that the command must carry, so that an echo tells which it was
  Vector6d F_Ho_D = Vector6d::Zero();   ///< what is sent, within all bounds
  ForceOff off = ForceOff::kNotActive;  ///< why nothing is sent; kNone: it is
  std::uint32_t stages = 0;             ///< bits of SafetyStage
  double energy = 0;                    ///< the observer's [J]
};

/// Ticks in which each thing happened since construction.
struct SafetyCounters {
  std::uint64_t ticks = 0;                            ///< since construction
  std::uint64_t off = 0;                              ///< without force
  std::uint64_t trips = 0;                            ///< latched
  std::array<std::uint64_t, kSafetyStages> stages{};  ///< by SafetyStage
};

/// The last word on every wrench, between the tick and the device, for any device:
///
///   gate (e-stop, life cycle, link, finite figures, dead man) - trips on speed and energy - soft
///   start - passivity - brake - clamp on |f| and |m| that keeps the direction - slew limit.
///
/// The brake is a damper on what the handle is faster than 0.7 of the speed that trips: something
/// heavy that falls drags the handle along, and does not throw it.
/// Of a device that exerts no moment the moments are dropped first. After a sample that is missing
/// the wrench changes no faster than kCatchUp until it is again the one that is wanted; the speed
/// of the hand is judged over the gap.
///
/// The energy is that of the wrench which was really at work: sensed by the device, or told by its
/// echo, or else the one sent a delay ago.
///
/// Gains are limited before, where they are set (LimitedGains). Its guarantee: the wrench is
/// finite, within the clamp, and the energy given to the hand beyond what was received and stored
/// stays below EnergyBound. No allocation after construction.
class SafetyFilter {
 public:
  /// @throws std::invalid_argument as Validate, or if neither the options nor the device state a
  ///         largest force. Without a largest moment no moment is sent.
  SafetyFilter(const SafetyOptions& options, const DeviceInfo& info);

  /// Once per tick, in their order.
  [[nodiscard]] SafetyOutput Apply(const SafetyInput& input) noexcept VMECH_NONBLOCKING;

  /// Starts the ramp again: at a grasp, a release or a change of gains. Energy starts anew.
  void Restart() noexcept;
  /// Another grasp or none: what the mechanism stores then is the new zero, without a ramp.
  void ForgetStoredEnergy() noexcept { passivity_.ForgetStoredEnergy(); }
  /// Releases the latch; what caused it must be over, else the next Apply latches again.
  void Unlatch() noexcept;

  /// What the device exerted during the period before its latest sample: sensed, or told by its
  /// echo, or else sent a delay ago. Before Apply of that sample.
  Vector6d WrenchAtWork(const MasterState& state) const noexcept;
  /// The same with what the soft start withheld of it, where that is carried: what is charged.
  Vector6d WrenchCharged(const MasterState& state) const noexcept;

  /// The cause of a trip; kNone: there was none.
  ForceOff latched() const noexcept { return latched_; }
  const SafetyCounters& counters() const noexcept { return counters_; }  ///< since construction
  /// The energy that the hand has not given, beyond the grace of the passivity controller [J].
  double Debt() const noexcept {
    return std::max(0.0, -passivity_.energy() - options_.passivity.grace);
  }
  /// Largest debt of energy [J]: the trip, and what the greatest force does at the greatest speed
  /// while commands on their way arrive and the last one expires.
  double EnergyBound() const noexcept;

 private:
  static constexpr std::uint64_t kMemory = 64;
  static constexpr double kCatchUp = 1000, kCatchUpMoment = 50;  // [N/s], [N m/s]

  ForceOff Gate(const SafetyInput& input) noexcept;
  void CountStages(std::uint32_t stages) noexcept;
  bool IsFresh(const SafetyInput& input) const noexcept;
  void Observe(const SafetyInput& input) noexcept;
  void Account(const SafetyInput& input, const Screw& dX, double elapsed) noexcept;
  std::uint64_t CommandAtWork(const MasterState& state, std::uint64_t latest) const noexcept;
  Screw ExertedBy(std::uint64_t command, const MasterState& state) const noexcept;
  Screw ChargedFor(std::uint64_t command, const MasterState& state) const noexcept;
  ForceOff Trip() const noexcept;
  // The stages that change the wrench of this tick.
  void Ramp(Screw* F, SafetyOutput* out) noexcept;
  void Damp(Screw* F, SafetyOutput* out) noexcept;
  void Brake(Screw* F, SafetyOutput* out) const noexcept;
  void Clamp(const WrenchLimit& room, Screw* F, SafetyOutput* out) noexcept;
  void Slew(Screw* F, SafetyOutput* out) noexcept;

  SafetyOptions options_;
  double period_, delay_;
  double brake_, angular_brake_;  // [N s/m], [N m s/rad]
  PassivityController passivity_;
  SafetyCounters counters_;
  ForceOff latched_ = ForceOff::kNone;
  bool open_ = false;         // the gate in the last tick
  bool has_pose_ = false;     // last_sample_ is one
  bool catching_up_ = false;  // after a missing sample
  int missing_ = 0;           // samples in a row
  double opened_for_ = 0;     // [s]
  MasterState last_sample_;
  Screw smooth_V_;                              // for the trip
  Screw last_;                                  // the last wrench that went out
  std::array<Screw, kMemory> sent_, withheld_;  // by sequence
};

}  // namespace vmech
