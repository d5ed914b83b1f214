#include "vmech/comparison/statistics.h"

#include <algorithm>
#include <limits>
#include <map>

namespace vmech {

Tally TallyOf(const Suite& suite, const std::vector<Result>& results, const Filter& filter) {
  Tally tally;
  for (const Result& result : results) {
    if (!Counts(result) || !filter(result)) continue;
    ++tally.problems;
    tally.targets += result.targets;
    tally.reached += result.reached;
    tally.jumps += result.jumps;
    if (!Succeeded(result, suite.blocks[result.problem.block].kind)) continue;
    ++tally.succeeded;
    tally.own += result.branch == Branch::kOwn ? 1 : 0;
    tally.other += result.branch == Branch::kOther ? 1 : 0;
  }
  return tally;
}

std::vector<SolverEntry> SolversOf(const std::vector<Result>& results) {
  std::vector<SolverEntry> solvers;
  for (const SolverEntry& solver : AllContestants()) {
    if (std::any_of(results.begin(), results.end(),
                    [&](const Result& result) { return result.solver == solver; })) {
      solvers.push_back(solver);
    }
  }
  return solvers;
}

std::vector<std::vector<double>> CostsOf(const Suite& suite, const std::vector<Result>& results,
                                         const std::vector<SolverEntry>& solvers,
                                         const Filter& filter,
                                         const std::function<double(const Result&)>& measure) {
  std::map<ProblemId, std::vector<double>> costs;
  for (const Result& result : results) {
    const auto solver = std::find(solvers.begin(), solvers.end(), result.solver);
    if (!Counts(result) || solver == solvers.end() || !filter(result)) continue;
    std::vector<double>& row = costs[result.problem];
    row.resize(solvers.size(), std::numeric_limits<double>::infinity());
    if (Succeeded(result, suite.blocks[result.problem.block].kind)) {
      row[static_cast<size_t>(solver - solvers.begin())] = measure(result);
    }
  }
  std::vector<std::vector<double>> rows;
  for (auto& [problem, row] : costs) rows.push_back(std::move(row));
  return rows;
}

double MedianOf(std::vector<double> values) {
  if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
  std::sort(values.begin(), values.end());
  const size_t n = values.size();
  return 0.5 * (values[(n - 1) / 2] + values[n / 2]);
}

}  // namespace vmech
