#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <optional>
#include <stdexcept>
#include <thread>
#include <utility>
#include <vector>

#include "vmech/apps/commands.h"
#include "vmech/apps/console/option_error.h"
#include "vmech/apps/files/file_kind.h"
#include "vmech/apps/files/inputs_apart.h"
#include "vmech/apps/files/parameter_options.h"
#include "vmech/apps/haptic/handle_home.h"
#include "vmech/apps/haptic/haptic_session.h"
#include "vmech/apps/haptic/haptic_view.h"
#include "vmech/apps/haptic/interrupt_scope.h"
#include "vmech/apps/haptic/recording_page.h"
#include "vmech/apps/haptic/session_recording.h"
#include "vmech/dynamics/in_hand/passive_joints.h"
#include "vmech/hw_interface/audit/promise.h"
#include "vmech/hw_interface/audit/recorded_tree.h"
#include "vmech/hw_interface/loop/replay_master.h"
#include "vmech/hw_interface/loop/runner.h"
#include "vmech/hw_interface/recording/recording_file.h"
#include "vmech/hw_interface/recording/recording_reader.h"
#include "vmech/hw_interface/rendering/coupled_tick.h"
#include "vmech/hw_interface/safety/stability.h"
#include "vmech/hw_interface/variation/varied_tick.h"
#include "vmech/kinematics/loops/assembled_mechanism.h"
#include "vmech/kinematics/tree/forward_kinematics.h"
#include "vmech/mechanisms/files/document.h"
#include "vmech/mechanisms/plausibility.h"
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

/// The mechanism with its loops closed, within its limits.
Mechanism Assembled(const HapticArguments& arguments, Mechanism mechanism) {
  const std::string file = arguments.file.string();
  if (arguments.tolerance) mechanism.tolerance = *arguments.tolerance;
  const AssembledMechanism assembled = AssembleMechanism(mechanism);
  if (!assembled.summary.closed) {
    throw std::runtime_error(fmt::format("{}: {}", file, assembled.summary.message));
  }
  for (const std::string& outside : StartsOutsideLimits(assembled.mechanism)) {
    throw FileErrors(file, outside + "; give start values within the limits");
  }
  if (!arguments.quiet) {
    for (const std::string& note : assembled.Notes()) fmt::print("note: {}\n", note);
    for (const std::string& doubt : DoubtsOf(mechanism)) fmt::print("warning: {}\n", doubt);
  }
  return assembled.mechanism;
}

/// A mechanism that is held, where the hand takes hold.
struct HeldMechanism {
  explicit HeldMechanism(const HapticArguments& arguments)
      : HeldMechanism(ReadSubject(arguments.file, arguments.grasps, arguments.set),
                      [&](const Mechanism& mechanism) { return Assembled(arguments, mechanism); }) {
  }
  /// That of a recording, as it was.
  explicit HeldMechanism(const RecordingHeader& header)
      : HeldMechanism(
            HapticSubject{
                RecordedTree(header).tree.mechanism, RecordedTree(header).grasp_indices, {}},
            [](const Mechanism& mechanism) { return mechanism; }) {}

  template <typename Assemble>
  HeldMechanism(HapticSubject held, const Assemble& assemble)
      : subject(std::move(held)),
        tree(BuildKinematicTree(assemble(subject.mechanism), KeepPassiveJoints(subject.mechanism))),
        q(StartCoordinates(tree)),
        R_WD(DeviceAxes(subject.mechanism)) {
    TreeWorkspace<double> ws(tree);
    ForwardKinematics(tree, q.data(), &ws);
    for (const int index : subject.grasps) {
      const GraspFrame grasp = GraspFrameOf(tree, index);
      X_WG.push_back(PoseInWorld(ws, grasp.node, grasp.X_BG));
    }
  }

  /// Held by a hand as its device can: at a point where it exerts no moments.
  void FitTo(const DeviceInfo& device, std::size_t hand, bool quiet) {
    Grasp& grasp = tree.mechanism.grasps[static_cast<std::size_t>(subject.grasps[hand])];
    if (!ForcesAlone(device) || grasp.kind == GraspKind::kPoint) return;
    grasp.kind = GraspKind::kPoint;
    if (quiet) return;
    fmt::print(
        "note: {} exerts forces and no moments; it holds the mechanism at the point of "
        "grasp {}, which turns as it likes\n",
        device.name, grasp.name);
  }

  HapticSubject subject;
  KinematicTree tree;
  VectorXd q;
  Matrix3d R_WD;
  std::vector<Posed> X_WG;  // of every hand
};

using Masters = std::vector<std::unique_ptr<Master>>;

WorkspaceOptions WorkspaceOf(const HapticArguments& arguments) {
  WorkspaceOptions workspace;
  workspace.motion_scale = arguments.motion_scale;
  workspace.clutch = arguments.clutch - 1;
  workspace.known = ParseHandle(arguments.handle);
  return workspace;
}

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

/// The clock that a session goes by.
std::unique_ptr<LoopClock> ClockOf(const HapticArguments& arguments) {
  if (arguments.free_running) return std::make_unique<FreeRunningClock>();
  return std::make_unique<WallClock>();
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

/// Runs the loop of configured masters, one for each hand, and reports.
int Hold(const HeldMechanism& held, const HapticArguments& arguments, const Masters& masters,
         LoopClock* clock) {
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

/// The arguments that made a recording. @throws std::invalid_argument if it does not say.
HapticArguments ArgumentsOf(const Recording& recording, const ReplayArguments& replay) {
  HapticArguments arguments;
  arguments.file =
      replay.file.empty() ? std::filesystem::path(recording.Note("file")) : replay.file;
  arguments.record = replay.record;
  arguments.force = replay.force;
  if (arguments.file.empty() || recording.Note("coupling").empty()) {
    throw std::invalid_argument(
        fmt::format("{}: does not say what was held; only recordings of `vmech haptic --record` do",
                    replay.recording.string()));
  }
  arguments.grasps.clear();
  for (int hand = 0; hand < recording.hands(); ++hand) {
    const std::string grasp = recording.Note(RecordingHeader::KeyOf("grasp", hand));
    if (!grasp.empty()) arguments.grasps.push_back(grasp);
  }
  arguments.coupling = recording.Note("coupling");
  const auto number = [&](const char* key) {
    const std::string text = recording.Note(key);
    char* end = nullptr;
    const double value = std::strtod(text.c_str(), &end);
    if (!text.empty() && *end == 0) return value;
    throw std::invalid_argument(
        fmt::format("{}: '# note {} {}' is not a number", replay.recording.string(), key, text));
  };
  arguments.scale = number("scale");
  arguments.stiffness = number("stiffness");
  arguments.inertia = number("inertia");
  for (const auto& [key, word] : {std::pair{"contact", &arguments.contact},
                                  {"estimator", &arguments.estimator},
                                  {"wrench", &arguments.wrench}}) {
    if (const std::string text = recording.Note(key); !text.empty()) *word = text;
  }
  arguments.gripper = number("gripper") != 0;
  for (const auto& [key, word] : recording.notes) {
    if (key == "set") arguments.set.push_back(word);
  }
  arguments.seconds = recording.period * static_cast<double>(recording.ticks.size());
  arguments.free_running = !replay.view;
  arguments.view = replay.view;
  arguments.varied = false;
  arguments.post_mortem = false;
  arguments.quiet = replay.quiet;
  return arguments;
}

/// Looks at every number of a recording.
int Audit(const std::filesystem::path& file) {
  RecordingReader reader(file);
  const AuditedRecording audited = AuditRecording(&reader);
  fmt::print("{}{}{}", audited.report.Text(), audited.felt, audited.state);
  return audited.report.sound() ? kSuccess : kNoSolution;
}

/// A grasp for every device.
void RequireGraspsForMasters(const HapticArguments& arguments) {
  const std::size_t hands = arguments.masters.size();
  const bool named = arguments.grasps.size() == hands || (hands == 1 && arguments.grasps.empty());
  if (!named) {
    throw OptionError(fmt::format("--grasp: {} given for {} device{}; give one for each --master",
                                  arguments.grasps.size(), hands, hands == 1 ? "" : "s"));
  }
  if (arguments.grips.size() > hands) {
    throw OptionError(fmt::format("--grip: {} given for {} device{}; give one for each --master",
                                  arguments.grips.size(), hands, hands == 1 ? "" : "s"));
  }
}

/// What the virtual coupling does not know is not passed over in silence.
void RequireOptionsOfCoupling(const HapticArguments& arguments) {
  if (arguments.coupling == "paper") return;
  const HapticArguments plain;
  const std::pair<const char*, bool> of_the_paper[] = {
      {"--stiffness", arguments.stiffness != plain.stiffness},
      {"--inertia", arguments.inertia != plain.inertia},
      {"--contact", arguments.contact != plain.contact},
      {"--estimator", arguments.estimator != plain.estimator},
      {"--wrench", arguments.wrench != plain.wrench}};
  for (const auto& [option, given] : of_the_paper) {
    if (!given) continue;
    throw OptionError(fmt::format(
        "{}: counts in the paper's way alone; add --coupling paper, or leave it out", option));
  }
}

/// What the scaled motion makes of a device's force is one that a filter can hold.
void RequireBearable(const DeviceInfo& device) {
  constexpr double kMost = 1e4;  // [N], of SafetyOptions
  if (device.linear.peak <= kMost) return;
  throw OptionError(
      fmt::format("--motion-scale: makes {:.4g} N of the largest force of {}, more than {:g} N; "
                  "give a larger one",
                  device.linear.peak, device.name, kMost));
}

/// Nothing is written over what a session reads.
void RequireRecordApart(const HapticArguments& arguments) {
  if (arguments.record.empty()) return;
  constexpr std::string_view kReplay = "replay:";
  std::vector<std::filesystem::path> inputs{arguments.file};
  for (const std::string& master : arguments.masters) {
    if (master.starts_with(kReplay)) inputs.emplace_back(master.substr(kReplay.size()));
  }
  RequireOutputsApart(inputs, {arguments.record});
}

}  // namespace

int RunHaptic(const HapticArguments& arguments) {
  RequireRecordApart(arguments);
  RequireGraspsForMasters(arguments);
  RequireOptionsOfCoupling(arguments);
  const WorkspaceOptions workspace = WorkspaceOf(arguments);
  HeldMechanism held(arguments);
  const std::unique_ptr<LoopClock> clock = ClockOf(arguments);
  Masters masters;
  for (std::size_t i = 0; i < arguments.masters.size(); ++i) {
    const std::string& grip = arguments.grips[std::min(i, arguments.grips.size() - 1)];
    std::unique_ptr<Master> master =
        MakeMaster({arguments.masters[i], arguments.rate, ParseGrip(grip), held.R_WD, held.X_WG[i],
                    i == 0 ? held.subject.law : std::nullopt, held.subject.end, arguments.gripper,
                    static_cast<unsigned>(i + 1)});
    master->Configure();
    if (!arguments.home.empty()) {
      BringHome(master.get(), clock.get(), Vector3d(arguments.home.data()));
    }
    masters.push_back(InWorkspace(workspace, std::move(master)));
    RequireBearable(masters.back()->info());
    held.FitTo(masters.back()->info(), i, arguments.quiet);
  }
  return Hold(held, arguments, masters, clock.get());
}

int RunReplay(const ReplayArguments& replay) {
  if (replay.audit) return ReadRecordingFor("replay", replay.recording, Audit);
  std::vector<std::filesystem::path> outputs;
  for (const std::filesystem::path& output : {replay.record, replay.motion}) {
    if (!output.empty()) outputs.push_back(output);
  }
  std::vector<std::filesystem::path> inputs{replay.recording};
  if (!replay.file.empty()) inputs.push_back(replay.file);
  RequireOutputsApart(inputs, outputs);
  const Recording recording = ReadRecordingFor("replay", replay.recording, [](const auto& file) {
    return ReadRecording(file, RecordingPart::kSamples);
  });
  if (!recording.complete && !replay.quiet) {
    fmt::print("note: the recording was cut short: it has no last line\n");
  }
  const HapticArguments arguments = ArgumentsOf(recording, replay);
  const bool as_it_was = replay.file.empty() && !recording.mechanism.text.empty();
  HeldMechanism held = as_it_was ? HeldMechanism(static_cast<const RecordingHeader&>(recording))
                                 : HeldMechanism(arguments);
  if (!replay.motion.empty()) {
    WriteHandMotion(replay.motion, recording, held.R_WD, held.X_WG.front());
  }
  Masters masters;
  for (int i = 0; i < recording.hands(); ++i) {
    masters.push_back(std::make_unique<ReplayMaster>(recording, ReplayKind::kSession, i));
    masters.back()->Configure();
    held.FitTo(masters.back()->info(), static_cast<std::size_t>(i), arguments.quiet);
  }
  const std::unique_ptr<LoopClock> clock = ClockOf(arguments);
  return Hold(held, arguments, masters, clock.get());
}

}  // namespace vmech
