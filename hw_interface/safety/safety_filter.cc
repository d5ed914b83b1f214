#include "vmech/hw_interface/safety/safety_filter.h"

#include <algorithm>
#include <cmath>

#include "vmech/base/check_range.h"
#include "vmech/base/rotation_error.h"
#include "vmech/base/screw_algebra.h"

namespace vmech {
namespace {

bool IsLatched(ForceOff cause) {
  return cause >= ForceOff::kEmergencyStop;
}

bool IsFinite(const Double4& a) {
  return std::isfinite(a[0] + a[1] + a[2]);
}

bool IsFinite(const Posed& X_DH) {
  const Frame X = FrameOf(X_DH);
  return IsFinite(X.x + X.y + X.z + X.p);
}

SafetyOptions Completed(SafetyOptions options, const DeviceInfo& info) {
  options.Validate();
  const auto complete = [](double* option, double device) {
    if (*option == 0) *option = device;
  };
  complete(&options.max_force, info.linear.peak);
  complete(&options.max_moment, info.angular.peak);
  complete(&options.max_speed, info.linear.max_speed);
  complete(&options.max_angular_speed, info.angular.max_speed);
  CheckRange("SafetyOptions for '" + info.name + "'", "max_force", options.max_force, 1e-6, 1e4);
  CheckRange("SafetyOptions for '" + info.name + "'", "max_moment", options.max_moment, 0, 1e3);
  return options;
}

/// -c V of what a speed is beyond most of the one that trips, and no more than `peak` there.
Double4 BrakingForce(const Double4& V, double c, double max_speed, double peak) {
  constexpr double kFree = 0.7;
  const double speed = Length(V), beyond = speed - kFree * max_speed;
  if (!(beyond > 0)) return Double4{};
  c = std::min(c, peak / ((1 - kFree) * max_speed));
  return (-c * beyond / speed) * V;
}

/// The factor that brings a pair of vectors within a pair of lengths; at most 1.
double Shrink(const Screw& F, double force, double moment) {
  const double f2 = Dot(F.linear, F.linear), m2 = Dot(F.angular, F.angular);
  double scale = 1;
  if (f2 > force * force) scale = force / std::sqrt(f2);
  if (m2 > moment * moment) scale = std::min(scale, moment / std::sqrt(m2));
  return scale;
}

}  // namespace

void SafetyOptions::Validate() const {
  CheckRange("SafetyOptions", "soft_start", soft_start, 0, 10);
  CheckRange("SafetyOptions", "hold_periods", hold_periods, 0, 1000);
  CheckRange("SafetyOptions", "max_force", max_force, 0, 1e4);
  CheckRange("SafetyOptions", "max_moment", max_moment, 0, 1e3);
  CheckRange("SafetyOptions", "force_slew", force_slew, 1, 1e7);
  CheckRange("SafetyOptions", "moment_slew", moment_slew, 0.1, 1e6);
  CheckRange("SafetyOptions", "max_speed", max_speed, 0, 100);
  CheckRange("SafetyOptions", "max_angular_speed", max_angular_speed, 0, 1000);
  CheckRange("SafetyOptions", "energy_trip", energy_trip, 1e-4, 100);
  passivity.Validate();
}

SafetyOptions WithoutBlows(SafetyOptions safety, const DeviceInfo& device) {
  constexpr double kOfPeak = 0.1;
  const double per_tick = kOfPeak / device.period;
  const auto limit = [&](double peak, double least, double* slew) {
    if (peak > 0) *slew = std::min(*slew, std::max(least, per_tick * peak));
  };
  limit(device.linear.peak, 1, &safety.force_slew);
  limit(device.angular.peak, 0.1, &safety.moment_slew);
  return safety;
}

SafetyFilter::SafetyFilter(const SafetyOptions& options, const DeviceInfo& info)
    : options_(Completed(options, info)),
      period_(info.period),
      delay_(info.delay),
      brake_(MostDamping(info.linear.mass, info)),
      angular_brake_(MostDamping(info.angular.mass, info)),
      passivity_(options.passivity, info) {}

void SafetyFilter::Restart() noexcept {
  opened_for_ = 0;
  passivity_.Reset();
}

void SafetyFilter::Unlatch() noexcept {
  latched_ = ForceOff::kNone;
  smooth_V_ = {};
  Restart();
}

SafetyOutput SafetyFilter::Apply(const SafetyInput& input) noexcept VMECH_NONBLOCKING {
  SafetyOutput out;
  out.sequence = ++counters_.ticks;
  sent_[out.sequence % kMemory] = withheld_[out.sequence % kMemory] = {};
  out.off = Gate(input);
  if (out.off == ForceOff::kNone) {
    if (!open_) Restart();
    Observe(input);
    out.off = Trip();
  }
  if (IsLatched(out.off) && latched_ == ForceOff::kNone) {
    latched_ = out.off;
    ++counters_.trips;
  }
  open_ = out.off == ForceOff::kNone;
  out.energy = passivity_.energy();
  if (!open_) {
    ++counters_.off;
    last_ = {};
    return out;
  }
  Screw F = ScrewOf(input.F_Ho_D);
  if (options_.max_moment == 0) F.angular = Double4{};
  Ramp(&F, &out);
  Damp(&F, &out);
  // What passivity damps of rotations too: it would take the force along in the clamp.
  if (options_.max_moment == 0) F.angular = Double4{};
  Brake(&F, &out);
  Clamp(input.room, &F, &out);
  Slew(&F, &out);
  out.F_Ho_D = Vector6Of(F);
  if (out.stages != 0) CountStages(out.stages);
  sent_[out.sequence % kMemory] = last_ = F;
  return out;
}

void SafetyFilter::CountStages(std::uint32_t stages) noexcept {
  for (int i = 0; i < kSafetyStages; ++i) counters_.stages[i] += (stages >> i) & 1;
}

/// A sample that the filter has not seen; a device may repeat its last one.
bool SafetyFilter::IsFresh(const SafetyInput& input) const noexcept {
  const bool seen = has_pose_ && input.state->sequence == last_sample_.sequence;
  return input.io == IoStatus::kOk && !seen;
}

ForceOff SafetyFilter::Gate(const SafetyInput& input) noexcept {
  missing_ = IsFresh(input) ? 0 : missing_ + 1;
  if (missing_ > 0) catching_up_ = true;
  if (latched_ != ForceOff::kNone) return latched_;
  if (input.state->emergency_stop) return ForceOff::kEmergencyStop;
  if (input.lifecycle != Lifecycle::kActive && input.lifecycle != Lifecycle::kFault) {
    has_pose_ = false;
    return ForceOff::kNotActive;
  }
  if (input.io == IoStatus::kLinkLost) return ForceOff::kLinkLost;
  if (input.io == IoStatus::kDeviceFault || input.lifecycle == Lifecycle::kFault) {
    return ForceOff::kDeviceFault;
  }
  const Screw F = ScrewOf(input.F_Ho_D);
  if (!IsFinite(F.linear + F.angular) || !IsFinite(input.state->X_DH) ||
      !std::isfinite(input.stored_energy)) {
    return ForceOff::kNonFinite;
  }
  if (missing_ > options_.hold_periods) return ForceOff::kStale;
  if (!input.state->dead_man) return ForceOff::kDeadMan;
  return ForceOff::kNone;
}

/// Displacement, twist and energy since the last sample, however long ago that was.
void SafetyFilter::Observe(const SafetyInput& input) noexcept {
  if (!IsFresh(input)) return;
  const MasterState& state = *input.state;
  if (has_pose_) {
    const Screw dX = HandError(FrameOf(last_sample_.X_DH), FrameOf(state.X_DH));
    const double elapsed = PeriodsBetween(last_sample_, state, period_) * period_;
    Account(input, dX, elapsed);
    constexpr double kSmoothing = 5e-3;  // [s]: single encoder steps do not trip
    smooth_V_ += std::min(1.0, elapsed / kSmoothing) * ((1 / elapsed) * dX - smooth_V_);
  } else {
    Account(input, {}, period_);
    smooth_V_ = {};
  }
  last_sample_ = state;
  has_pose_ = true;
}

/// Nothing was at work while the gate was closed.
void SafetyFilter::Account(const SafetyInput& input, const Screw& dX, double elapsed) noexcept {
  if (!open_) {
    passivity_.Observe({}, {}, elapsed, input.stored_energy);
    return;
  }
  // This tick's command is still to come.
  const Screw wrench = ChargedFor(CommandAtWork(*input.state, counters_.ticks - 1), *input.state);
  passivity_.Observe(wrench, dX, elapsed, input.stored_energy);
}

Vector6d SafetyFilter::WrenchAtWork(const MasterState& state) const noexcept {
  return Vector6Of(ExertedBy(CommandAtWork(state, counters_.ticks), state));
}

Vector6d SafetyFilter::WrenchCharged(const MasterState& state) const noexcept {
  return Vector6Of(ChargedFor(CommandAtWork(state, counters_.ticks), state));
}

/// Somebody else carries what the soft start withholds.
Screw SafetyFilter::ChargedFor(std::uint64_t command, const MasterState& state) const noexcept {
  Screw wrench = ExertedBy(command, state);
  if (command > 0) wrench += withheld_[command % kMemory];
  return wrench;
}

/// Its sequence; 0 if unknown. `latest` is that of the last command sent.
std::uint64_t SafetyFilter::CommandAtWork(const MasterState& state,
                                          std::uint64_t latest) const noexcept {
  const auto delay = static_cast<std::uint64_t>(std::llround(delay_ / period_));
  const std::uint64_t at_work =
      state.valid & kSensesEcho ? state.command_echo : latest - std::min(latest, delay);
  return at_work <= latest && latest - at_work < kMemory ? at_work : 0;
}

Screw SafetyFilter::ExertedBy(std::uint64_t command, const MasterState& state) const noexcept {
  if (state.valid & kSensesAppliedWrench) return ScrewOf(state.applied_F_Ho_D);
  return command > 0 ? sent_[command % kMemory] : Screw{};
}

ForceOff SafetyFilter::Trip() const noexcept {
  if (Shrink(smooth_V_, options_.max_speed, options_.max_angular_speed) < 1) {
    return ForceOff::kSpeed;
  }
  if (passivity_.energy() < -options_.energy_trip) return ForceOff::kEnergy;
  return ForceOff::kNone;
}

void SafetyFilter::Ramp(Screw* F, SafetyOutput* out) noexcept {
  if (opened_for_ < options_.soft_start) {
    const double share = opened_for_ / options_.soft_start;
    if (options_.carried_start) {
      const double within = Shrink(*F, options_.max_force, options_.max_moment);
      withheld_[out->sequence % kMemory] = (1 - share) * within * *F;
    }
    *F = share * *F;
    out->stages |= kRamped;
  }
  opened_for_ += period_;
}

void SafetyFilter::Damp(Screw* F, SafetyOutput* out) noexcept {
  if (passivity_.Control(F)) out->stages |= kDamped;
}

void SafetyFilter::Brake(Screw* F, SafetyOutput* out) const noexcept {
  const Screw& V = passivity_.V();
  const Screw brake{
      BrakingForce(V.linear, brake_, options_.max_speed, options_.max_force),
      BrakingForce(V.angular, angular_brake_, options_.max_angular_speed, options_.max_moment)};
  if (Power(brake, brake) == 0) return;
  *F += brake;
  out->stages |= kBraked;
}

void SafetyFilter::Clamp(const WrenchLimit& room, Screw* F, SafetyOutput* out) noexcept {
  const double scale = std::min(Shrink(*F, options_.max_force, options_.max_moment),
                                room.Share(Length(F->linear), Length(F->angular)));
  if (scale >= 1) return;
  *F = scale * *F;
  out->stages |= kClamped;
}

void SafetyFilter::Slew(Screw* F, SafetyOutput* out) noexcept {
  const Screw change = *F - last_;
  double force = options_.force_slew, moment = options_.moment_slew;
  if (catching_up_) {
    force = std::min(force, kCatchUp);
    moment = std::min(moment, kCatchUpMoment);
  }
  const double scale = Shrink(change, force * period_, moment * period_);
  if (scale == 1) {
    catching_up_ = missing_ > 0;
    return;
  }
  *F = last_ + scale * change;
  out->stages |= kSlewed;
}

double SafetyFilter::EnergyBound() const noexcept {
  const double power = options_.max_force * options_.max_speed +
                       options_.max_moment * std::min(options_.max_angular_speed, 1e3);
  return options_.energy_trip + power * ((2 + options_.hold_periods) * period_ + delay_);
}

const char* NameOf(ForceOff cause) noexcept {
  switch (cause) {
    case ForceOff::kNone:
      return "none";
    case ForceOff::kNotActive:
      return "not active";
    case ForceOff::kDeadMan:
      return "dead man";
    case ForceOff::kStale:
      return "stale";
    case ForceOff::kEmergencyStop:
      return "emergency stop";
    case ForceOff::kLinkLost:
      return "link lost";
    case ForceOff::kDeviceFault:
      return "device fault";
    case ForceOff::kNonFinite:
      return "not a number";
    case ForceOff::kSpeed:
      return "too fast";
    case ForceOff::kEnergy:
      return "energy";
  }
  return "";
}

const char* AdviceFor(ForceOff cause) noexcept {
  switch (cause) {
    case ForceOff::kEmergencyStop:
      return "release the emergency stop and start again";
    case ForceOff::kLinkLost:
      return "look at the cable and at the program on the device's side, then start again";
    case ForceOff::kDeviceFault:
      return "the device has switched its motors off: clear its fault, then start again";
    case ForceOff::kNonFinite:
      return "a figure was no number: check the device's calibration; the last ticks show which";
    case ForceOff::kSpeed:
      return "hold the handle more firmly, let the mechanism weigh less with --scale, or give its "
             "joints viscous friction";
    case ForceOff::kEnergy:
      return "render less with --scale, give the joints viscous friction, hold more firmly, or "
             "check the masses, delay and resolution that the device states";
    default:
      return "";
  }
}

}  // namespace vmech
