#include <fmt/format.h>

#include <cstdlib>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "vmech/apps/commands.h"
#include "vmech/apps/files/inputs_apart.h"
#include "vmech/apps/haptic/hold_mechanism.h"
#include "vmech/apps/haptic/recording_page.h"
#include "vmech/apps/haptic/session_recording.h"
#include "vmech/hw_interface/loop/replay_master.h"
#include "vmech/hw_interface/recording/recording_file.h"
#include "vmech/hw_interface/recording/recording_reader.h"

namespace vmech {
namespace {

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

}  // namespace

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
  return HoldMechanism(held, arguments, masters, clock.get());
}

}  // namespace vmech
