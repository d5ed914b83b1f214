#include "vmech/hw_interface/loop/runner.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "vmech/base/check_range.h"
#include "vmech/base/rotation_error.h"
#include "vmech/base/screw_algebra.h"

namespace vmech {
namespace {

std::unique_ptr<ArmTorques> MakeTorques(const RunnerOptions& options, const DeviceInfo& info) {
  if (!options.joint_torques || !info.takes_torque || !info.arm) return nullptr;
  return std::make_unique<ArmTorques>(options.posture, info.arm, info.period,
                                      info.angular.resolution);
}

std::unique_ptr<HandObserver> MakeObserver(const RunnerOptions& options, const Tick& tick,
                                           const DeviceInfo& info) {
  if (!tick.UsesObservedHand() || options.observer.bandwidth == 0) return nullptr;
  if (!HandObserver::Suits(info)) return nullptr;
  return std::make_unique<HandObserver>(options.observer, info);
}

std::size_t RingSize(const RunnerOptions& options, std::uint64_t slots) {
  const auto keep = static_cast<std::uint64_t>(options.keep);
  return static_cast<std::size_t>(options.record ? std::max(slots, keep) : keep);
}

}  // namespace

void RunnerOptions::Validate() const {
  CheckRange("RunnerOptions", "seconds", seconds, record ? 1e-9 : 0, 1e6);
  CheckRange("RunnerOptions", "keep", keep, 1, 1e6);
  CheckRange("RunnerOptions", "command_life", command_life, 1, 1000);
  safety.Validate();
  observer.Validate();
  posture.Validate();
  if (realtime) realtime->Validate();
}

Runner::Runner(const RunnerOptions& options, Master* master, Tick* tick, LoopClock* clock)
    : options_(options),
      master_(master),
      tick_(tick),
      clock_(clock),
      period_(master->info().period),
      period_ns_(std::llround(period_ * 1e9)),
      safety_(options.safety, master->info()),
      torques_(MakeTorques(options, master->info())),
      observer_(MakeObserver(options, *tick, master->info())),
      channels_(tick->ChannelNames()) {
  options.Validate();
  slots_ = static_cast<std::uint64_t>(std::llround(options.seconds / period_));
  kept_.resize(RingSize(options, slots_));
  summary_.device = master->info().name;
  summary_.period = period_;
}

RunSummary Runner::Run() {
  std::optional<RealtimeScope> scope;
  if (options_.realtime) scope.emplace(*options_.realtime);
  if (scope) summary_.realtime = scope->report();
  const unsigned mode = SetFlushToZero();
  master_->Activate();
  std::int64_t slot_ns = clock_->Now();
  while (!IsOver()) {
    clock_->SleepUntil(slot_ns);
    const std::int64_t now_ns = clock_->Now();
    const std::int64_t skipped = (now_ns - slot_ns) / period_ns_;
    slot_ns += skipped * period_ns_;
    TickRecord& record = kept_[summary_.ticks % kept_.size()];
    record.skipped = static_cast<std::int32_t>(skipped);
    record.late_ns = static_cast<std::int32_t>(now_ns - slot_ns);
    RunSlot(slot_ns, &record);
    Account(record, now_ns);
    slot_ns += period_ns_;
  }
  master_->Deactivate();
  RestoreFloatingPoint(mode);
  scope.reset();
  Finish();
  return summary_;
}

bool Runner::IsOver() const noexcept {
  const bool time_over = slots_ > 0 && summary_.ticks + summary_.skipped >= slots_;
  return time_over || stop_ || failed_ || safety_.latched() != ForceOff::kNone;
}

void Runner::RunSlot(std::int64_t slot_ns, TickRecord* record) noexcept {
  WallClock stopwatch;
  const std::int64_t start = stopwatch.Now();
  record->io = ReadMaster(slot_ns, &state_);
  record->state = state_;
  const TickOutput wanted = StepTick(record->io, record);
  const SafetyOutput safe =
      safety_.Apply({master_->lifecycle(), record->io, &state_, record->wanted_F_Ho_D,
                     wanted.stored_energy, torques_ ? torques_->room() : WrenchLimit{}});
  Send(slot_ns, safe);
  record->sent_F_Ho_D = safe.F_Ho_D;
  record->off = safe.off;
  record->stages = safe.stages;
  record->energy = safe.energy;
  failed_ = wanted.status == TickStatus::kFailed;
  summary_.held += wanted.status == TickStatus::kHeld;
  record->compute_ns = static_cast<std::int32_t>(stopwatch.Now() - start);
}

IoStatus Runner::ReadMaster(std::int64_t slot_ns, MasterState* state) noexcept {
  const IoStatus io = master_->Read(slot_ns, state);
  if (emergency_stop_) state->emergency_stop = true;
  fresh_ = io == IoStatus::kOk;
  if (fresh_) gap_ = missing_;
  missing_ = fresh_ ? 0 : missing_ + 1;
  summary_.missed += fresh_ ? 0 : 1;
  return io;
}

/// The wrench of the mechanism on the hand, in the device's axes.
TickOutput Runner::StepTick(IoStatus io, TickRecord* record) noexcept VMECH_NONBLOCKING {
  TickOutput out;
  record->channels.fill(0);
  record->wanted_F_Ho_D.setZero();
  if (!registered_) {
    if (io != IoStatus::kOk) return out;
    Register();
    last_sample_ = state_;
    registered_ = true;
  }
  MovingFrame observed;
  const Matrix3d& R_WD = registration_.X_WD.R;
  const Vector6d F_Ho_D = safety_.WrenchCharged(state_);
  const Vector6d charged = Stacked<double>(R_WD * F_Ho_D.head<3>(), R_WD * F_Ho_D.tail<3>());
  if (fresh_) {
    if (gap_ > options_.safety.hold_periods) TakeUpAgain();
    Observe();
    GraspOrLetGo();
  }
  TickInput input;
  input.held = holds_;
  input.fresh = fresh_;
  input.elapsed = fresh_ ? PeriodsBetween(last_sample_, state_, period_) * period_ : 0;
  input.state = &state_;
  if (torques_) input.room = torques_->room();
  input.debt = safety_.Debt();
  input.charged_F_Ho_W = &charged;
  if (observer_) {
    registration_.TakeHandInWorld(HandNow(), &observed);
    input.observed = &observed;
  } else {
    input.X_WH = registration_.HandInWorld(state_.X_DH);
  }
  if (fresh_) last_sample_ = state_;
  out = tick_->Step(input, std::span<double>(record->channels.data(), channels_.size()));
  const Matrix3d R_DW = registration_.X_WD.R.transpose();
  record->wanted_F_Ho_D << R_DW * out.F_Ho_W.head<3>(), R_DW * out.F_Ho_W.tail<3>();
  if (out.status == TickStatus::kFailed) record->wanted_F_Ho_D.setZero();
  return out;
}

void Runner::Observe() noexcept {
  if (!observer_) return;
  const auto periods = std::lround(PeriodsBetween(last_sample_, state_, period_));
  observer_->Update(state_, safety_.WrenchAtWork(state_), static_cast<int>(periods));
}

/// As observed; where samples are missing, the hand goes on as it did, for a few periods.
MovingFrame Runner::HandNow() const noexcept {
  MovingFrame hand = observer_->hand_D();
  const int ahead = std::min(missing_, options_.safety.hold_periods);
  if (ahead > 0) hand.X = Displaced(hand.X, (ahead * period_) * hand.V);
  return hand;
}

/// Puts the hand where the grasp frame is.
void Runner::Register() noexcept {
  registration_ = GraspedAt(options_.R_WD, state_.X_DH, tick_->GraspFrame());
  tick_->Reset();
  if (torques_) torques_->Reset();
  if (observer_) observer_->Reset();
  holds_ = !options_.gripper;
  summary_.grasps += holds_;
}

/// After a gap for which there was no force: the hand, wherever it has gone, has hold of the grasp
/// frame where that is.
void Runner::TakeUpAgain() noexcept {
  if (observer_) observer_->Reset();
  registration_ = GraspedAt(options_.R_WD, state_.X_DH, tick_->GraspFrame());
}

void Runner::GraspOrLetGo() noexcept {
  const bool closes = GripperCloses();
  if (closes == holds_) return;
  holds_ = closes;
  safety_.ForgetStoredEnergy();
  if (!closes) return;
  ++summary_.grasps;
  const Posed X_DH = observer_ ? observer_->X_DH() : state_.X_DH;
  if (!tick_->GraspAt(registration_.HandInWorld(X_DH))) {
    safety_.Restart();
    registration_ = GraspedAt(options_.R_WD, state_.X_DH, tick_->GraspFrame());
    tick_->Reset();
  }
}

/// With a dead zone between closed and open.
bool Runner::GripperCloses() const noexcept {
  if (!options_.gripper || !(state_.valid & kSensesGripper)) return true;
  constexpr double kClosed = 0.1, kOpen = 0.2;  // [rad]
  return state_.gripper_opening < (holds_ ? kOpen : kClosed);
}

void Runner::Send(std::int64_t slot_ns, const SafetyOutput& safe) noexcept {
  MasterCommand command;
  command.sequence = safe.sequence;
  command.valid_until_ns = slot_ns + options_.command_life * period_ns_;
  command.F_Ho_D = safe.F_Ho_D;
  if (safe.off == ForceOff::kNone) {
    if (torques_) {
      command.mode = CommandMode::kJointTorque;
      torques_->Resolve(state_, fresh_, &command);
    } else if (master_->info().takes_wrench) {
      command.mode = CommandMode::kWrench;
    }
  }
  // A write that does not arrive shows as a lost link in the next read.
  (void)master_->Write(command);
}

void Runner::Account(const TickRecord& record, std::int64_t now_ns) noexcept {
  ++summary_.ticks;
  summary_.skipped += static_cast<std::uint64_t>(record.skipped);
  summary_.late.Add(record.late_ns + record.skipped * period_ns_);
  summary_.compute.Add(record.compute_ns);
  if (last_wake_ns_ >= 0) summary_.interval.Add(now_ns - last_wake_ns_);
  last_wake_ns_ = now_ns;
  const double force = record.sent_F_Ho_D.head<3>().norm();
  summary_.peak_force = std::max(summary_.peak_force, force);
  summary_.peak_moment = std::max(summary_.peak_moment, record.sent_F_Ho_D.tail<3>().norm());
  summary_.least_energy = std::min(summary_.least_energy, record.energy);
  live_.ticks = summary_.ticks;
  live_.skipped = summary_.skipped;
  live_.force = force;
  live_.energy = record.energy;
  live_.compute_ns = record.compute_ns;
  live_.off = record.off;
}

void Runner::Finish() {
  summary_.safety = safety_.counters();
  summary_.cause = safety_.latched();
  const bool fault = failed_ || summary_.cause != ForceOff::kNone;
  summary_.status = fault ? RunStatus::kFault : stop_ ? RunStatus::kStopped : RunStatus::kFinished;
  if (!fault || options_.post_mortem.empty()) return;
  WriteRecording(options_.post_mortem, LastTicks(static_cast<std::uint64_t>(options_.keep)));
  summary_.post_mortem = options_.post_mortem;
}

Recording Runner::Kept() const {
  return LastTicks(kept_.size());
}

Recording Runner::LastTicks(std::uint64_t count) const {
  const DeviceInfo& info = master_->info();
  Recording recording{summary_.device, period_,     channels_,    {},
                      info.delay,      info.linear, info.angular, options_.notes};
  count = std::min({count, summary_.ticks, static_cast<std::uint64_t>(kept_.size())});
  recording.ticks.reserve(count);
  for (std::uint64_t i = summary_.ticks - count; i < summary_.ticks; ++i) {
    recording.ticks.push_back(kept_[i % kept_.size()]);
  }
  return recording;
}

}  // namespace vmech
