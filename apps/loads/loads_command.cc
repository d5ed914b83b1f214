#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <csignal>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <string_view>
#include <thread>

#include "vmech/apps/commands.h"
#include "vmech/apps/console/progress_bar.h"
#include "vmech/apps/files/file_kind.h"
#include "vmech/apps/files/parameter_options.h"
#include "vmech/apps/files/result_folder.h"
#include "vmech/apps/loads/named_study.h"
#include "vmech/apps/loads/printed_summary.h"
#include "vmech/apps/loads/simulated_motion.h"
#include "vmech/apps/loads/study_results.h"
#include "vmech/mechanisms/files/file_errors.h"
#include "vmech/studies/study.h"
#include "vmech/studies/study_reader.h"

namespace vmech {
namespace {

std::atomic<bool> interrupted = false;

/// While it lives, Ctrl-C ends a simulation and not the command, so that what was computed is
/// written.
class InterruptsEndTheRun {
 public:
  InterruptsEndTheRun() {
    interrupted = false;
    for (const int signal : {SIGINT, SIGTERM}) std::signal(signal, [](int) { interrupted = true; });
  }
  ~InterruptsEndTheRun() {
    for (const int signal : {SIGINT, SIGTERM}) std::signal(signal, SIG_DFL);
  }
};

int Threads(const LoadsArguments& arguments) {
  if (arguments.threads > 0) return arguments.threads;
  return std::clamp(static_cast<int>(std::thread::hardware_concurrency()), 1, 64);
}

/// @throws FileErrors if the study is for the other command.
StudyFile ReadFor(const char* command, const LoadsArguments& arguments) {
  StudyFile file = ReadWithSettings(arguments.set, [&](auto settings) {
    return ReadAs({command, {FileKind::kStudy}}, arguments.study,
                  [&](const auto& path) { return ReadStudy(path, settings); });
  });
  const bool simulates = std::string_view(command) == "simulate";
  if (arguments.motion.empty() && simulates != file.simulation.has_value()) {
    throw FileErrors(arguments.study.string(),
                     simulates ? "has no block `simulation`; `vmech loads` runs its motion"
                               : "is to be simulated; `vmech simulate` does that, and --motion "
                                 "takes what came of it");
  }
  if (arguments.tolerance) file.study.mechanism.tolerance = *arguments.tolerance;
  return file;
}

std::filesystem::path FolderFor(const char* command, const LoadsArguments& arguments) {
  if (!arguments.out.empty()) return arguments.out;
  return arguments.study.stem().string() + "-" + command;
}

StudyOutcome RunWithBar(const char* command, const StudyFile& file,
                        const LoadsArguments& arguments) {
  LoadStudyOptions options;
  options.threads = Threads(arguments);
  ProgressBar bar(command, file.study.times.size(), arguments.quiet);
  options.progress = [&](size_t done) {
    bar.Show(done);
    return !interrupted;
  };
  return RunNamedStudy(file, options);
}

/// Writes and tells what came of it.
void Deliver(const StudyFile& file, const StudyOutcome& outcome, const LoadsArguments& arguments,
             ResultFolder* folder) {
  if (arguments.strict) RequireNoWarning(file, outcome);
  WriteStudyResults(file, outcome, VMECH_VERSION, Threads(arguments), folder);
  if (!arguments.quiet) PrintSummary(file, outcome, folder->path());
}

}  // namespace

int RunLoads(const LoadsArguments& arguments) {
  StudyFile file = ReadFor("loads", arguments);
  std::string unfinished;
  if (!arguments.motion.empty()) unfinished = TakeMotionOf(arguments.motion, &file);
  ResultFolder folder(FolderFor("loads", arguments), ResultKind::kLoads);
  const StudyOutcome outcome = RunWithBar("loads", file, arguments);
  Deliver(file, outcome, arguments, &folder);
  if (!unfinished.empty()) {
    fmt::print(stderr, "{}: a partial motion, of a simulation that is {}\n",
               arguments.motion.string(), unfinished);
    return kNoSolution;
  }
  return BearingsMet(outcome) ? kSuccess : kNotMet;
}

int RunSimulate(const LoadsArguments& arguments) {
  const StudyFile file = ReadFor("simulate", arguments);
  StudyOutcome outcome;
  {
    const InterruptsEndTheRun interrupts;
    outcome = RunWithBar("simulate", file, arguments);
  }
  const SimulationStatus status = outcome.simulation->status;
  if (outcome.loads.poses.empty()) {
    throw std::runtime_error(
        fmt::format("{}: {}", arguments.study.string(), outcome.simulation->message));
  }
  ResultFolder folder(FolderFor("simulate", arguments), ResultKind::kSimulation);
  Deliver(file, outcome, arguments, &folder);
  if (status != SimulationStatus::kFinished && status != SimulationStatus::kReached) {
    fmt::print(stderr, "{}: the simulation is {}: {}\n", arguments.study.string(), NameOf(status),
               outcome.simulation->message);
    return kNoSolution;
  }
  return BearingsMet(outcome) ? kSuccess : kNotMet;
}

}  // namespace vmech
