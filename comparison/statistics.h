#pragma once

#include <functional>
#include <vector>

#include "vmech/comparison/result.h"

namespace vmech {

/// How a set of results came out. Problems that a mechanism does not have and solvers that are not
/// installed do not count.
struct Tally {
  int problems = 0;        ///< those that count
  int succeeded = 0;       ///< as Succeeded()
  int targets = 0;         ///< those of paths each by itself
  int reached = 0;         ///< how many of these were reached
  int jumps = 0;           ///< of paths, to another branch
  int own = 0, other = 0;  ///< branches of what succeeded

  /// `succeeded` over `problems`; 0 of none.
  double share() const { return problems == 0 ? 0 : double(succeeded) / problems; }
};

/// Tells which results count.
using Filter = std::function<bool(const Result&)>;

/// Counts the results that the filter lets pass.
Tally TallyOf(const Suite& suite, const std::vector<Result>& results, const Filter& filter);

/// The solvers that results are of, in the order of AllContestants.
std::vector<SolverEntry> SolversOf(const std::vector<Result>& results);

/// One row per problem that a filter lets pass, one column per solver: a measure where the solver
/// succeeded, infinity where it did not.
std::vector<std::vector<double>> CostsOf(const Suite& suite, const std::vector<Result>& results,
                                         const std::vector<SolverEntry>& solvers,
                                         const Filter& filter,
                                         const std::function<double(const Result&)>& measure);

/// The middle one, or the mean of the two in the middle; NaN of none.
double MedianOf(std::vector<double> values);

}  // namespace vmech
