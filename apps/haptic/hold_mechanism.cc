#include "vmech/apps/haptic/hold_mechanism.h"

#include <fmt/format.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <cstdio>
#include <optional>
#include <thread>
#include <utility>

#include "vmech/apps/files/file_kind.h"
#include "vmech/apps/files/parameter_options.h"
#include "vmech/apps/haptic/haptic_view.h"
#include "vmech/apps/haptic/interrupt_scope.h"
#include "vmech/apps/haptic/session_recording.h"
#include "vmech/hw_interface/audit/promise.h"
#include "vmech/hw_interface/audit/recorded_tree.h"
#include "vmech/hw_interface/loop/runner.h"
#include "vmech/hw_interface/rendering/coupled_tick.h"
#include "vmech/hw_interface/safety/stability.h"
#include "vmech/hw_interface/variation/varied_tick.h"
#include "vmech/studies/study_reader.h"

namespace vmech {
namespace {

/// Prints the newest figures ten times a second while it lives, on a terminal only.
class StatusLine {
 public:
  StatusLine(const Runner& runner, bool quiet) {
    if (quiet || !isatty(STDERR_FILENO)) return;
    thread_ = std::thread([this, &runner] {
      while (!done_) {
        const LiveStatus& live = runner.live();
        fmt::print(stderr, "\r{:>9} ticks  {:>7.2f} N  compute {:>6.1f} us  skipped {:<6} {:<15}",
                   live.ticks.load(), live.force.load(),
                   1e-3 * static_cast<double>(live.compute_ns.load()), live.skipped.load(),
                   live.off == ForceOff::kNone ? "force on" : NameOf(live.off));
        std::this_thread::sleep_for(std::chrono::milliseconds(100));
      }
      fmt::print(stderr, "\r{:78}\r", "");
    });
  }
  ~StatusLine() {
    done_ = true;
    if (thread_.joinable()) thread_.join();
  }

 private:
  std::atomic<bool> done_ = false;
  std::thread thread_;
};

/// What the filter is to hold; a device without force has no limits, and nothing is at work.
SafetyOptions SafetyFor(const DeviceInfo& device, SafetyOptions safety) {
  constexpr double kAnything = 1e3;  // [N], [N m]
  if (!device.takes_wrench && !device.takes_torque) {
    safety.max_force = safety.max_moment = kAnything;
  }
  return safety;
}

RunnerOptions OptionsOf(const HapticArguments& arguments, const HeldMechanism& held,
                        const Rendering& rendering) {
  RunnerOptions options;
  options.seconds = arguments.seconds;
  if (arguments.post_mortem) options.post_mortem = arguments.file.stem().string() + "-fault.csv";
  options.R_WD = held.R_WD;
  options.gripper = arguments.gripper;
  options.notes = {{"file", arguments.file.string()},
                   {"coupling", arguments.coupling},
                   {"scale", fmt::to_string(arguments.scale)},
                   {"stiffness", fmt::to_string(arguments.stiffness)},
                   {"inertia", fmt::to_string(arguments.inertia)},
                   {"contact", arguments.contact},
                   {"estimator", arguments.estimator},
                   {"wrench", arguments.wrench},
                   {"gripper", fmt::to_string(static_cast<int>(arguments.gripper))}};
  for (const std::string& word : arguments.set) options.notes.emplace_back("set", word);
  for (std::size_t i = 0; i < rendering.hands.size(); ++i) {
    const RenderedHand& hand = rendering.hands[i];
    const int index = static_cast<int>(i);
    options.notes.emplace_back(RecordingHeader::KeyOf("grasp", index),
                               held.tree.mechanism.grasps[hand.grasp].name);
    for (const auto& note : NotesOf(hand.promise, index)) options.notes.push_back(note);
  }
  options.mechanism = RecordedMechanismOf(held.tree);
  if (arguments.free_running) options.realtime.reset();
  return options;
}

std::vector<RunnerHand> HandsOf(const Rendering& rendering, const Masters& masters) {
  std::vector<RunnerHand> hands;
  for (std::size_t i = 0; i < masters.size(); ++i) {
    const RenderedHand& hand = rendering.hands[i];
    hands.push_back({masters[i].get(), SafetyFor(masters[i]->info(), hand.safety), hand.observer});
  }
  return hands;
}

/// Lets a page vary the design of what is held, if its file has parameters: in the virtual
/// coupling, and where nothing is recorded, since a recording is of one mechanism.
LiveVariation VaryTick(const HeldMechanism& held, const HapticArguments& arguments,
                       Rendering* rendering) {
  if (!arguments.varied || dynamic_cast<CoupledTick*>(rendering->tick.get()) == nullptr) return {};
  auto design =
      KindOfFile(arguments.file) == FileKind::kStudy
          ? std::make_unique<LiveDesign>(ReadStudy(arguments.file, ParseSettings(arguments.set)))
          : std::make_unique<LiveDesign>(arguments.file, ParseSettings(arguments.set));
  if (!design->any()) return {};
  if (!arguments.record.empty()) {
    fmt::print("note: parameters cannot be moved while it is recorded\n");
    return {};
  }
  design->Hold(held.tree, held.subject.grasps);
  std::unique_ptr<CoupledTick> coupled(static_cast<CoupledTick*>(rendering->tick.release()));
  auto varied = std::make_unique<VariedTick>(std::move(coupled), design->Start());
  LiveVariation variation{varied.get(), std::move(design)};
  rendering->tick = std::move(varied);
  return variation;
}

}  // namespace

std::unique_ptr<LoopClock> ClockOf(const HapticArguments& arguments) {
  if (arguments.free_running) return std::make_unique<FreeRunningClock>();
  return std::make_unique<WallClock>();
}

int HoldMechanism(const HeldMechanism& held, const HapticArguments& arguments,
                  const Masters& masters, LoopClock* clock) {
  std::vector<RenderedHand> hands;
  for (std::size_t i = 0; i < masters.size(); ++i) {
    hands.push_back({held.subject.grasps[i], &masters[i]->info(), {}, {}, {}});
  }
  Rendering rendering =
      MakeRendering({arguments.coupling, arguments.scale, arguments.stiffness, arguments.inertia,
                     arguments.contact, arguments.estimator, arguments.wrench},
                    held.tree, std::move(hands), held.q);
  LiveVariation variation;
  if (arguments.view) variation = VaryTick(held, arguments, &rendering);
  const VariedTick* const varied = variation.tick;
  RunnerOptions options = OptionsOf(arguments, held, rendering);
  if (varied != nullptr) options.mechanism = {};  // the last ticks may be another mechanism's
  Runner runner(options, HandsOf(rendering, masters), rendering.tick.get(), clock);
  SessionRecording recording({arguments.record, arguments.force, arguments.free_running}, held.tree,
                             held.subject.grasps.front(), &runner);
  if (!arguments.quiet) {
    for (const auto& master : masters) fmt::print("{}", BoundsReport(master->info()));
    fmt::print("{}", rendering.report);
  }
  RunSummary summary;
  std::optional<HapticView> view;
  if (arguments.view) {
    view.emplace(held.tree, &runner, std::move(variation));
    fmt::print("The session is shown at\n  {}\n", view->url());
    std::fflush(stdout);
  }
  {
    const InterruptScope interrupt(&runner);
    const StatusLine line(runner, arguments.quiet);
    summary = runner.Run();
  }
  recording.Finish();
  if (varied != nullptr && varied->varied()) recording.ForgetFelt();
  if (!arguments.quiet) {
    fmt::print("{}{}{}", summary.FullReport(), rendering.tick->FullReport(), recording.Report());
  }
  recording.RequireWritten();
  return summary.status == RunStatus::kFault ? kNoSolution : kSuccess;
}

}  // namespace vmech
