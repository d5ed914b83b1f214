#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>
#include <stdexcept>
#include <thread>

#include "vmech/apps/commands.h"
#include "vmech/apps/common_options.h"
#include "vmech/apps/compare/comparison_report.h"
#include "vmech/apps/compare/digest.h"
#include "vmech/apps/compare/journal.h"
#include "vmech/apps/compare/report_sections.h"
#include "vmech/apps/compare/result_text.h"
#include "vmech/apps/compare/run_comparison.h"
#include "vmech/apps/compare/suite_reader.h"
#include "vmech/apps/compare/summary_json.h"
#include "vmech/apps/console/option_error.h"
#include "vmech/apps/console/progress_bar.h"
#include "vmech/apps/files/file_kind.h"
#include "vmech/apps/files/parameter_options.h"
#include "vmech/apps/files/result_folder.h"
#include "vmech/apps/mpi/mpi_session.h"
#include "vmech/comparison/statistics.h"
#include "vmech/comparison/target_maker.h"
#include "vmech/mechanisms/files/document.h"

namespace vmech {
namespace {

constexpr const char* kCompareHelp =
    "Solves every problem of a suite by every solver, on all processors, and writes what came of "
    "it:\n"
    "  results.csv    one row per problem and solver\n"
    "  summary.json   shares of success and times, for programs\n"
    "  report.html    tables, performance profiles, accuracy, every failure with its reason\n"
    "  rows.jsonl     the rows as they came in. Stopped at any time, the same command goes on "
    "from\n"
    "                 here; with more solvers it adds theirs.\n"
    "mpirun -n 4 vmech compare ... gives the same rows.";

int Jobs(const CompareArguments& arguments) {
  if (arguments.jobs > 0) return arguments.jobs;
  return std::clamp(static_cast<int>(std::thread::hardware_concurrency()), 1, 256);
}

/// The solvers of that names, each once, in the order of tables; all if there is no name.
std::vector<SolverEntry> SolversNamed(const std::vector<std::string>& names) {
  std::vector<std::string> known;
  for (const SolverEntry solver : AllContestants()) known.emplace_back(solver.name());
  std::vector<SolverEntry> solvers;
  for (const std::string& name : names) {
    const std::optional<SolverEntry> solver = ContestantFromName(name);
    if (!solver) {
      throw OptionError(fmt::format("--solvers: {} is no solver{}; there are {}", Quoted(name),
                                    DidYouMean(name, known), fmt::join(known, ", ")));
    }
    solvers.push_back(*solver);
  }
  if (names.empty()) solvers = AllContestants();
  std::sort(solvers.begin(), solvers.end());
  solvers.erase(std::unique(solvers.begin(), solvers.end()), solvers.end());
  return solvers;
}

/// Finds out before anything runs whether every mechanism can be assembled.
void CheckMechanisms(const Suite& suite) {
  for (const SuiteMechanism& mechanism : suite.mechanisms) Subject assembled(mechanism);
}

void PrintSummary(const Suite& suite, const std::vector<Result>& results,
                  const ResultFolder& folder) {
  size_t width = 8;
  for (const SolverEntry solver : AllContestants()) width = std::max(width, solver.name().size());
  fmt::print("{}: {} rows, solved of each kind\n  {:<{}}", suite.name, results.size(), "", width);
  for (const TargetBlock& block : suite.blocks) fmt::print(" {:>12}", block.name);
  fmt::print("\n");
  for (const SolverEntry solver : SolversOf(results)) {
    fmt::print("  {:<{}}", solver.name(), width);
    for (size_t b = 0; b < suite.blocks.size(); ++b) {
      const Tally tally = TallyOf(suite, results, [&](const Result& r) {
        return r.solver == solver && r.problem.block == static_cast<int>(b);
      });
      fmt::print(" {:>12}", tally.problems == 0 ? "-" : Percent(tally.succeeded, tally.problems));
    }
    fmt::print("\n");
  }
  fmt::print("written to {}\n", (folder.path() / "report.html").string());
}

int Compare(const CompareArguments& arguments, MpiSession* mpi) {
  const Suite suite = ReadWithSettings(arguments.set, [&](auto settings) {
    return ReadAs({"compare", {FileKind::kSuite}}, arguments.suite,
                  [&](const auto& path) { return ReadSuite(path, settings); });
  });
  const std::vector<SolverEntry> solvers = SolversNamed(arguments.solvers);
  CheckMechanisms(suite);
  const Work work = ComparisonWork(suite);
  if (mpi != nullptr && mpi->is_worker()) {
    mpi->Serve(work);
    return kSuccess;
  }
  const std::filesystem::path by_name = arguments.suite.stem().string() + "-compare";
  const std::filesystem::path& folder_name = arguments.out.empty() ? by_name : arguments.out;
  ResultFolder folder(folder_name, ResultKind::kComparison);
  Journal journal(folder_name, {suite.digest, DigestOfThisProgram(), VMECH_VERSION}, suite);
  const Spread spread = [&](const std::vector<std::string>& tasks, const Coordinator& coordinator) {
    mpi != nullptr ? mpi->Run(tasks, coordinator)
                   : RunInProcesses(Jobs(arguments), tasks, work, coordinator);
  };
  std::vector<Result> results;
  {
    ProgressBar bar("compare", RowsOf(suite, solvers), arguments.quiet);
    results = RunComparison(suite, solvers, spread, &journal, [&](size_t done) { bar.Show(done); });
  }
  folder.Write("results.csv", ResultsTable(suite, results));
  folder.Write("summary.json", ComparisonSummary(suite, results, VMECH_VERSION));
  folder.Write("report.html", RenderComparisonReport(suite, results, VMECH_VERSION));
  folder.Commit();
  if (!arguments.quiet) PrintSummary(suite, results, folder);
  return kSuccess;
}

}  // namespace

void AddCompare(CLI::App* app, CompareArguments* compare) {
  CLI::App* command = app->add_subcommand("compare", kCompareHelp);
  AddFile(command, "SUITE", &compare->suite, "suite file, YAML or JSON");
  command->add_option("--solvers", compare->solvers, "names of solvers, by commas (default: all)")
      ->delimiter(',')
      ->type_name("NAMES");
  command
      ->add_option("--out", compare->out,
                   "folder for the results (default: <suite>-compare in this folder)")
      ->type_name("DIR");
  AddSet(command, &compare->set);
  command->add_option("--jobs", compare->jobs, "number of processes; 0: one per processor")
      ->check(CLI::Range(0, 256, "0..256"))
      ->capture_default_str();
  AddQuiet(command, &compare->quiet);
}

int RunCompare(const CompareArguments& arguments) {
  const std::unique_ptr<MpiSession> mpi = MpiSession::Join();
  if (mpi == nullptr || !mpi->is_worker()) return Compare(arguments, mpi.get());
  try {
    return Compare(arguments, mpi.get());
  } catch (const std::exception&) {
    return kBadInput;  // the first process says what is wrong
  }
}

}  // namespace vmech
