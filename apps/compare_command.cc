#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <stdexcept>
#include <thread>

#include "vmech/apps/commands.h"
#include "vmech/apps/compare/digest.h"
#include "vmech/apps/compare/journal.h"
#include "vmech/apps/compare/result_text.h"
#include "vmech/apps/compare/run_comparison.h"
#include "vmech/apps/compare/suite_reader.h"
#include "vmech/apps/mpi_session.h"
#include "vmech/apps/output_folder.h"
#include "vmech/apps/progress_bar.h"
#include "vmech/comparison/target_maker.h"
#include "vmech/mechanisms/document.h"

namespace vmech {
namespace {

int Jobs(const CompareArguments& arguments) {
  if (arguments.jobs > 0) return arguments.jobs;
  return std::clamp(static_cast<int>(std::thread::hardware_concurrency()), 1, 256);
}

/// The solvers of that names, each once, in the order of kAllBackends; all if there is no name.
std::vector<Backend> SolversNamed(const std::vector<std::string>& names) {
  std::vector<std::string> known;
  for (const Backend solver : kAllBackends) known.emplace_back(NameOf(solver));
  std::vector<Backend> solvers;
  for (const std::string& name : names) {
    const std::optional<Backend> solver = BackendFromName(name);
    if (!solver) {
      throw std::invalid_argument(fmt::format("--solvers: {} is no solver{}; there are {}",
                                              Quoted(name), DidYouMean(name, known),
                                              fmt::join(known, ", ")));
    }
    solvers.push_back(*solver);
  }
  if (names.empty()) solvers.assign(kAllBackends.begin(), kAllBackends.end());
  std::sort(solvers.begin(), solvers.end());
  solvers.erase(std::unique(solvers.begin(), solvers.end()), solvers.end());
  return solvers;
}

/// Finds out before anything runs whether every mechanism can be assembled.
void CheckMechanisms(const Suite& suite) {
  for (const SuiteMechanism& mechanism : suite.mechanisms) Subject assembled(mechanism);
}

int Compare(const CompareArguments& arguments, MpiSession* mpi) {
  const Suite suite = ReadSuite(arguments.suite);
  const std::vector<Backend> solvers = SolversNamed(arguments.solvers);
  CheckMechanisms(suite);
  const Work work = ComparisonWork(suite);
  if (mpi != nullptr && mpi->is_worker()) {
    mpi->Serve(work);
    return kSuccess;
  }
  const std::filesystem::path by_name = arguments.suite.stem().string() + "-compare";
  const std::filesystem::path& folder_name = arguments.out.empty() ? by_name : arguments.out;
  Journal journal(folder_name, {suite.digest, DigestOfThisProgram(), VMECH_VERSION}, suite);
  const Spread spread = [&](const std::vector<std::string>& tasks, const Foreman& foreman) {
    mpi != nullptr ? mpi->Run(tasks, foreman)
                   : RunInProcesses(Jobs(arguments), tasks, work, foreman);
  };
  std::vector<Result> results;
  {
    ProgressBar bar("compare", ProblemsOf(suite).size() * solvers.size(), arguments.quiet);
    results = RunComparison(suite, solvers, spread, &journal,
                            [&](size_t done, size_t) { bar.Show(done); });
  }
  OutputFolder folder(folder_name);
  folder.Write("results.csv", ResultsTable(suite, results));
  folder.Commit();
  return kSuccess;
}

}  // namespace

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
