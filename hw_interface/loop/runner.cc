#include "vmech/hw_interface/loop/runner.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "vmech/base/check_range.h"
#include "vmech/hw_interface/recording/recording_file.h"

namespace vmech {
namespace {

HandLoopOptions OptionsOf(const RunnerOptions& options, const RunnerHand& hand, const Tick& tick) {
  HandLoopOptions own;
  own.safety = hand.safety;
  own.observer = hand.observer;
  own.posture = options.posture;
  own.gripper = options.gripper;
  own.joint_torques = options.joint_torques;
  own.uses_observed = tick.UsesObservedHand();
  own.command_life = options.command_life;
  own.R_WD = options.R_WD;
  return own;
}

void RequireHands(std::span<const RunnerHand> hands, const Tick& tick) {
  if (static_cast<int>(hands.size()) != tick.hands()) {
    throw std::invalid_argument(
        fmt::format("Runner: {} devices for a mechanism in {} hands; give one for each",
                    hands.size(), tick.hands()));
  }
  const DeviceInfo& first = hands.front().master->info();
  for (const RunnerHand& hand : hands) {
    const DeviceInfo& info = hand.master->info();
    if (info.period == first.period) continue;
    throw std::invalid_argument(
        fmt::format("Runner: {} has a period of {:g} ms and {} one of {:g} ms; two hands need "
                    "devices of the same rate",
                    first.name, 1e3 * first.period, info.name, 1e3 * info.period));
  }
}

std::size_t RingSize(const RunnerOptions& options, std::uint64_t slots) {
  const auto keep = static_cast<std::uint64_t>(options.keep);
  return static_cast<std::size_t>(options.record ? std::max(slots, keep) : keep);
}

/// With everything as large as the tick will fill it.
TickRecord EmptyRecord(const Tick& tick) {
  TickRecord record;
  record.others.resize(static_cast<std::size_t>(tick.hands() - 1));
  record.picture.others.resize(record.others.size());
  tick.Show(&record.picture);
  record.channels.resize(tick.ChannelNames().size());
  return record;
}

std::vector<std::string> NamesOrNumbers(std::vector<std::string> names, std::size_t count) {
  if (names.size() == count) return names;
  names.clear();
  for (std::size_t i = 0; i < count; ++i) names.push_back(fmt::to_string(i));
  return names;
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
    : Runner(options, std::array{RunnerHand{master, options.safety, options.observer}}, tick,
             clock) {}

Runner::Runner(const RunnerOptions& options, std::span<const RunnerHand> hands, Tick* tick,
               LoopClock* clock)
    : options_(options),
      tick_(tick),
      clock_(clock),
      inputs_(hands.size()),
      outputs_(hands.size()),
      period_(hands.front().master->info().period),
      period_ns_(std::llround(period_ * 1e9)),
      channels_(tick->ChannelNames()),
      pictures_(EmptyRecord(*tick).picture) {
  options.Validate();
  RequireHands(hands, *tick);
  for (const RunnerHand& hand : hands) {
    hands_.push_back(std::make_unique<HandLoop>(OptionsOf(options, hand, *tick), hand.master));
  }
  slots_ = static_cast<std::uint64_t>(std::llround(options.seconds / period_));
  kept_.resize(RingSize(options, slots_), EmptyRecord(*tick));
  static_cast<HandSummary&>(summary_) = hands_.front()->Summary();
  summary_.period = period_;
}

RunSummary Runner::Run() {
  std::optional<RealtimeScope> scope;
  if (options_.realtime) scope.emplace(*options_.realtime);
  if (scope) summary_.realtime = scope->report();
  const unsigned mode = SetFlushToZero();
  Activate();
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
    if (recorder_ != nullptr) recorder_->Take(record);
    Show(record.picture);
    slot_ns += period_ns_;
  }
  Deactivate();
  RestoreFloatingPoint(mode);
  scope.reset();
  Finish();
  return summary_;
}

/// All, or none.
void Runner::Activate() {
  try {
    for (const auto& hand : hands_) hand->master().Activate();
  } catch (...) {
    Deactivate();
    throw;
  }
}

void Runner::Deactivate() noexcept {
  for (const auto& hand : hands_) hand->master().Deactivate();
}

bool Runner::IsOver() const noexcept {
  const bool time_over = slots_ > 0 && summary_.ticks + summary_.skipped >= slots_;
  return time_over || stop_ || failed_ || Cause() != ForceOff::kNone;
}

/// Why the loop has to stop: what tripped, or the last link that was lost.
ForceOff Runner::Cause() const noexcept {
  bool all_lost = true;
  for (const auto& hand : hands_) {
    if (hand->lost()) continue;
    if (hand->latched() != ForceOff::kNone) return hand->latched();
    all_lost = false;
  }
  return all_lost ? ForceOff::kLinkLost : ForceOff::kNone;
}

void Runner::RunSlot(std::int64_t slot_ns, TickRecord* record) noexcept {
  WallClock stopwatch;
  const std::int64_t start = stopwatch.Now();
  for (std::size_t i = 0; i < hands_.size(); ++i) {
    hands_[i]->Read(slot_ns, emergency_stop_, &record->of_hand(static_cast<int>(i)));
  }
  StepTick(record);
  for (std::size_t i = 0; i < hands_.size(); ++i) {
    hands_[i]->Send(slot_ns, outputs_[i].stored_energy, &record->of_hand(static_cast<int>(i)));
  }
  failed_ = outputs_.front().status == TickStatus::kFailed;
  summary_.held += outputs_.front().status == TickStatus::kHeld;
  record->compute_ns = static_cast<std::int32_t>(stopwatch.Now() - start);
}

/// The wrenches of the mechanism on the hands, in their devices' axes. Nothing moves before the
/// first of them has come.
void Runner::StepTick(TickRecord* record) noexcept VMECH_NONBLOCKING {
  std::fill(record->channels.begin(), record->channels.end(), 0.0);
  std::fill(outputs_.begin(), outputs_.end(), TickOutput{});
  RegisterThoseThatArrive();
  if (!started_) return;
  for (std::size_t i = 0; i < hands_.size(); ++i) {
    HandLoop& hand = *hands_[i];
    const int index = static_cast<int>(i);
    inputs_[i] = hand.registered() && !hand.lost()
                     ? hand.Prepare(index, tick_, &record->of_hand(index))
                     : hand.Absent();
  }
  tick_->StepHands(inputs_, outputs_, std::span<double>(record->channels.data(), channels_.size()));
  tick_->Show(&record->picture);
  for (std::size_t i = 0; i < hands_.size(); ++i) {
    const int index = static_cast<int>(i);
    hands_[i]->Take(outputs_[i], &record->picture.hand(index), &record->of_hand(index));
  }
}

void Runner::RegisterThoseThatArrive() noexcept {
  for (std::size_t i = 0; i < hands_.size(); ++i) {
    if (!hands_[i]->arrives()) continue;
    hands_[i]->Register(tick_->HeldFrame(static_cast<int>(i)));
    if (!started_) tick_->Reset();
    started_ = true;
  }
}

void Runner::Account(const TickRecord& record, std::int64_t now_ns) noexcept {
  ++summary_.ticks;
  summary_.skipped += static_cast<std::uint64_t>(record.skipped);
  summary_.late.Add(record.late_ns + record.skipped * period_ns_);
  summary_.compute.Add(record.compute_ns);
  if (last_wake_ns_ >= 0) summary_.interval.Add(now_ns - last_wake_ns_);
  last_wake_ns_ = now_ns;
  live_.ticks = summary_.ticks;
  live_.skipped = summary_.skipped;
  live_.force = record.sent_F_Ho_D.head<3>().norm();
  live_.energy = record.energy;
  live_.compute_ns = record.compute_ns;
  live_.off = record.off;
}

void Runner::Show(const TickPicture& picture) noexcept {
  if (!started_ || !pictures_.wanted()) return;
  pictures_.back() = picture;
  pictures_.Publish();
}

void Runner::Finish() {
  static_cast<HandSummary&>(summary_) = hands_.front()->Summary();
  for (std::size_t i = 1; i < hands_.size(); ++i) summary_.others.push_back(hands_[i]->Summary());
  summary_.cause = Cause();
  const bool fault = failed_ || summary_.cause != ForceOff::kNone;
  summary_.status = fault ? RunStatus::kFault : stop_ ? RunStatus::kStopped : RunStatus::kFinished;
  if (!fault || options_.post_mortem.empty()) return;
  WriteRecording(options_.post_mortem, LastTicks(static_cast<std::uint64_t>(options_.keep)));
  summary_.post_mortem = options_.post_mortem;
}

Recording Runner::Kept() const {
  return LastTicks(kept_.size());
}

RecordingHeader Runner::Header() const {
  RecordingHeader header;
  header.others.resize(hands_.size() - 1);
  for (std::size_t i = 0; i < hands_.size(); ++i) {
    const DeviceInfo& info = hands_[i]->master().info();
    RecordedDevice& device = i == 0 ? header : header.others[i - 1];
    device = {info.name, info.delay, info.linear, info.angular};
  }
  header.period = period_;
  header.channels = channels_;
  header.notes = options_.notes;
  header.states = tick_->StateNames();
  header.mechanism = options_.mechanism;
  const TickPicture& picture = kept_.front().picture;
  RecordedMechanism& names = header.mechanism;
  names.coordinates =
      NamesOrNumbers(std::move(names.coordinates), static_cast<std::size_t>(picture.q.size()));
  names.velocities =
      NamesOrNumbers(std::move(names.velocities), static_cast<std::size_t>(picture.v.size()));
  names.joints = NamesOrNumbers(std::move(names.joints), picture.joints.size());
  return header;
}

Recording Runner::LastTicks(std::uint64_t count) const {
  Recording recording{Header(), {}};
  count = std::min({count, summary_.ticks, static_cast<std::uint64_t>(kept_.size())});
  recording.ticks.reserve(count);
  for (std::uint64_t i = summary_.ticks - count; i < summary_.ticks; ++i) {
    recording.ticks.push_back(kept_[i % kept_.size()]);
  }
  return recording;
}

}  // namespace vmech
