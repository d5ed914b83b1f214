#pragma once

#include <string>
#include <vector>

#include "vmech/apps/html/markup.h"
#include "vmech/comparison/result.h"

namespace vmech {

/// The parts of the report on a comparison.

/// What all of them are made from.
struct ComparisonReport {
  const Suite& suite;
  const std::vector<Result>& results;
  std::vector<SolverEntry> solvers;
};

/// "100 %" of all, else rounded down to a tenth, so that nothing less looks like it.
std::string Percent(int part, int whole);
/// A solver's name, which may break at its underlines.
html::Markup SolverName(SolverEntry solver);

/// Per solver and block, and per mechanism.
html::Markup SuccessSection(const ComparisonReport& report);
/// Performance profiles on time and on evaluations.
html::Markup ProfileSection(const ComparisonReport& report);
/// How well the loops are closed and how stationary the poses are.
html::Markup AccuracySection(const ComparisonReport& report);
/// Median times per mechanism.
html::Markup TimeSection(const ComparisonReport& report);
/// Problems that nobody solved, and every failure with its reason.
html::Markup FailureSection(const ComparisonReport& report);

}  // namespace vmech
