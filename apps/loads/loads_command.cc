#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <atomic>
#include <csignal>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <string_view>
#include <thread>

#include "vmech/apps/commands.h"
#include "vmech/apps/common_options.h"
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

constexpr const char* kLoadsHelp =
    "Moves a mechanism as the study file says and writes the wrench at every joint, which of its\n"
    "components are certain, and the bearings that will carry it:\n"
    "  loads.csv      joint wrenches and drive forces at every pose\n"
    "  motion.csv     pose, velocity and acceleration of every link\n"
    "  joints.csv     coordinate, rate and acceleration of every freedom of every joint\n"
    "  certainty.csv  what statics determines and what it does not\n"
    "  bearings.csv   the bearing chosen at every position\n"
    "  summary.json   the figures that matter, for programs\n"
    "  report.html    the whole study as one page, to read and to pass on";

constexpr const char* kSimulateHelp =
    "Lets a mechanism move by its own dynamics, as the block `simulation` of a study says, with\n"
    "springs, friction, motors and limits, and writes what `vmech loads` writes, and:\n"
    "  energies.csv   where the energy is, what was supplied and dissipated, what is in error\n"
    "  events.csv     impacts at limits, contacts that stick and slip, coordinates reached\n"
    "Ctrl-C ends it with the results as far as it went, and exit code 3.";

void AddStudyOptions(CLI::App* command, const char* results, LoadsArguments* loads) {
  AddFile(command, "STUDY", &loads->study, "study file, YAML or JSON");
  command
      ->add_option(
          "--out", loads->out,
          fmt::format("folder for the results (default: <study>-{} in this folder)", results))
      ->type_name("DIR");
  command->add_option("--threads", loads->threads, "number of threads; 0: one per processor")
      ->check(CLI::Range(0, 64, "0..64"))
      ->capture_default_str();
  AddSet(command, &loads->set);
  AddTolerance(command, &loads->tolerance);
  AddStrict(command, &loads->strict);
  AddQuiet(command, &loads->quiet);
}

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

void AddLoads(CLI::App* app, LoadsArguments* loads) {
  CLI::App* command = app->add_subcommand("loads", kLoadsHelp);
  AddStudyOptions(command, "loads", loads);
  command
      ->add_option("--motion", loads->motion,
                   "result folder of vmech simulate or vmech loads, whose motion is taken in place "
                   "of the study's own")
      ->type_name("DIR");
}

void AddSimulate(CLI::App* app, LoadsArguments* simulated) {
  AddStudyOptions(app->add_subcommand("simulate", kSimulateHelp), "simulate", simulated);
}

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
