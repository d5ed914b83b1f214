#pragma once

#include <atomic>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "vmech/base/nonblocking.h"
#include "vmech/base/triple_buffer.h"
#include "vmech/hw_interface/loop/hand_loop.h"
#include "vmech/hw_interface/loop/histogram.h"
#include "vmech/hw_interface/loop/loop_clock.h"
#include "vmech/hw_interface/loop/realtime.h"
#include "vmech/hw_interface/recording/tick_recorder.h"
#include "vmech/hw_interface/rendering/tick.h"

namespace vmech {

/// How long a loop runs, and what is kept of it.
struct RunnerOptions {
  double seconds = 0;   ///< how long to run; 0: until Stop, in [0, 1e6]
  bool record = false;  ///< keep every tick; needs `seconds`
  int keep = 2000;      ///< last ticks that are kept in any case, in [1, 1e6]
  /// Where the last ticks are written after a fault; empty: nowhere.
  std::filesystem::path post_mortem;
  RecordingNotes notes;         ///< for the recordings
  RecordedMechanism mechanism;  ///< for the recordings
  int command_life = 5;  ///< periods after which the device drops a command by itself, in [1, 1000]
  bool gripper = false;  ///< hold only while the gripper is closed, where the device senses it
  bool joint_torques = true;             ///< where the device takes them; else wrenches
  Matrix3d R_WD = Matrix3d::Identity();  ///< the device's axes in the mechanism's world
  SafetyOptions safety;                  ///< what the motors may be asked for
  HandObserverOptions observer;          ///< where the device is an arm that states itself
  PostureOptions posture;                ///< of an arm whose joints are driven
  std::optional<RealtimeOptions> realtime = RealtimeOptions{};  ///< none: an ordinary thread

  /// @throws std::invalid_argument naming field, value and range.
  void Validate() const;
};

/// Why a loop ended.
enum class RunStatus : std::uint8_t {
  kNotRun,
  kFinished,  ///< the time is over
  kStopped,   ///< Stop was called
  kFault,     ///< the safety filter latched or the tick failed; the motors are off
};

/// What came of a run; every figure was measured here. Of several hands the first is the summary's.
struct RunSummary : HandSummary {
  RunStatus status = RunStatus::kNotRun;  ///< why it ended
  double period = 0;                      ///< [s]
  std::uint64_t ticks = 0;                ///< steps of the mechanism
  std::uint64_t skipped = 0;              ///< slots that passed while the loop was late
  std::uint64_t held = 0;                 ///< ticks in which the mechanism could not follow
  Histogram late, interval, compute;      ///< [ns]; `interval` from wake-up to wake-up
  std::vector<HandSummary> others;        ///< hands beside the first
  RealtimeReport realtime;                ///< memory, scheduling
  std::filesystem::path post_mortem;      ///< what was written after a fault

  std::string BriefReport() const;  ///< a line
  std::string FullReport() const;   ///< lines with every figure
};

/// One of several hands on a mechanism.
struct RunnerHand {
  Master* master = nullptr;      ///< configured
  SafetyOptions safety;          ///< what its motors may be asked for
  HandObserverOptions observer;  ///< where it is an arm that states itself
};

/// The newest figures of a running loop and its first hand, for other threads.
struct LiveStatus {
  std::atomic<std::uint64_t> ticks = 0, skipped = 0;  ///< as in RunSummary
  std::atomic<double> force = 0;                      ///< sent [N]
  std::atomic<double> energy = 0;                     ///< [J]
  std::atomic<std::int64_t> compute_ns = 0;           ///< of the last tick [ns]
  std::atomic<ForceOff> off = ForceOff::kNotActive;   ///< why no force is sent
};

/// The loop around a tick: sleep until the slot, read, step, filter, write. Slots lie on a grid of
/// the device's period; a late loop skips those that have passed and never catches up in a burst.
/// It owns the gate: the masters are active only while the loop runs. Each of several hands has its
/// own observer, registration and safety filter; a trip of one stops all, and one whose link is
/// lost lets go while the others go on. In a tick nothing allocates, locks, logs or throws.
class Runner {
 public:
  /// `master` must be configured; it, `tick` and `clock` must outlive the runner.
  /// @throws std::invalid_argument as the options' Validate and SafetyFilter.
  Runner(const RunnerOptions& options, Master* master, Tick* tick, LoopClock* clock);
  /// A hand for each that the tick has; safety and observer are theirs in place of the options'.
  /// @throws std::invalid_argument too for another number of hands, or periods that differ.
  Runner(const RunnerOptions& options, std::span<const RunnerHand> hands, Tick* tick,
         LoopClock* clock);

  /// Activates the masters, runs, deactivates them, writes the last ticks after a fault.
  /// @throws what Master::Activate and WriteRecording throw.
  RunSummary Run();

  /// From any thread or a signal handler.
  void Stop() noexcept { stop_ = true; }
  /// The same, and counts as a fault.
  void EmergencyStop() noexcept { emergency_stop_ = true; }

  const LiveStatus& live() const noexcept { return live_; }  ///< may be read from any thread
  /// The mechanism and its hands, for one other thread. A picture is made when the last one has
  /// been taken, and after the commands have been sent: whoever looks costs no tick any time.
  TripleBuffer<TickPicture>& pictures() noexcept { return pictures_; }
  double period() const noexcept { return period_; }  ///< [s]
  /// The ticks that were kept, oldest first.
  Recording Kept() const;
  /// What every recording of this run begins with.
  RecordingHeader Header() const;
  /// Gets every tick of the run from now on; null: nobody.
  void SetRecorder(TickRecorder* recorder) noexcept { recorder_ = recorder; }

 private:
  void Activate();
  void Deactivate() noexcept;
  bool IsOver() const noexcept;
  ForceOff Cause() const noexcept;
  void RunSlot(std::int64_t slot_ns, TickRecord* record) noexcept;
  void StepTick(TickRecord* record) noexcept VMECH_NONBLOCKING;
  void RegisterThoseThatArrive() noexcept;
  void Account(const TickRecord& record, std::int64_t now_ns) noexcept;
  void Show(const TickPicture& picture) noexcept;
  void Finish();
  Recording LastTicks(std::uint64_t count) const;

  RunnerOptions options_;
  Tick* tick_;
  LoopClock* clock_;
  std::vector<std::unique_ptr<HandLoop>> hands_;
  std::vector<TickInput> inputs_;
  std::vector<TickOutput> outputs_;
  double period_;
  std::int64_t period_ns_;
  std::vector<std::string> channels_;
  std::vector<TickRecord> kept_;  // a ring
  TripleBuffer<TickPicture> pictures_;
  TickRecorder* recorder_ = nullptr;
  RunSummary summary_;
  LiveStatus live_;
  std::uint64_t slots_ = 0;  // to run; 0: no end
  bool started_ = false, failed_ = false;
  std::int64_t last_wake_ns_ = -1;
  std::atomic<bool> stop_ = false, emergency_stop_ = false;
};

}  // namespace vmech
