#pragma once

#include <functional>
#include <string>
#include <vector>

#include "vmech/apps/compare/journal.h"
#include "vmech/apps/compare/process_pool.h"
#include "vmech/comparison/result.h"

namespace vmech {

/// How tasks are spread: RunInProcesses with a number of jobs, or an MpiSession.
using Spread =
    std::function<void(const std::vector<std::string>& tasks, const Coordinator& coordinator)>;

/// What a worker does for a comparison: solves the problem of a task by the solvers named with it.
Work ComparisonWork(const Suite& suite);

/// How many rows a comparison has: one per problem and solver that takes it.
size_t RowsOf(const Suite& suite, const std::vector<SolverEntry>& solvers);

/// Everything of a suite by these solvers, in the order of problems and of AllContestants; what the
/// journal has is not computed again. `progress` hears how many rows are there.
/// @throws what the journal throws.
std::vector<Result> RunComparison(const Suite& suite, const std::vector<SolverEntry>& solvers,
                                  const Spread& spread, Journal* journal,
                                  const std::function<void(size_t done)>& progress);

}  // namespace vmech
