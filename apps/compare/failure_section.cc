#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>
#include <tuple>

#include "vmech/apps/compare/report_sections.h"
#include "vmech/apps/html/page.h"
#include "vmech/apps/plot/scale.h"
#include "vmech/comparison/statistics.h"

namespace vmech {
namespace {

using html::Markup;

constexpr size_t kMostRows = 400;  // of a list; results.csv has them all
constexpr size_t kMostIndices = 8;

bool Failed(const ComparisonReport& report, const Result& result) {
  return Counts(result) && !Succeeded(result, report.suite.blocks[result.problem.block].kind);
}

std::string Number(double value) {
  return plot::FormatSignificant(value, 2);
}

std::string Indices(const std::vector<int>& indices) {
  std::string text;
  for (size_t i = 0; i < std::min(indices.size(), kMostIndices); ++i) {
    text += fmt::format("{}{}", i == 0 ? "" : ", ", indices[i] + 1);
  }
  return indices.size() > kMostIndices ? text + ", …" : text;
}

/// Problems that count and that no solver succeeded with.
Markup Unsolved(const ComparisonReport& report) {
  std::map<ProblemId, bool> solved;
  for (const Result& result : report.results) {
    if (!Counts(result)) continue;
    bool& by_someone = solved[result.problem];
    by_someone = by_someone || !Failed(report, result);
  }
  std::map<std::pair<int, int>, std::vector<int>> groups;
  for (const auto& [problem, by_someone] : solved) {
    if (!by_someone) groups[{problem.mechanism, problem.block}].push_back(problem.index);
  }
  if (groups.empty()) return html::Paragraph("Every problem was solved by some solver.");
  html::Table table;
  table.caption = "Problems that no solver solved.";
  table.columns = {{"Mechanism"}, {"Targets"}, {"Problems", true}, {"Which"}};
  for (const auto& [where, indices] : groups) {
    table.rows.push_back({report.suite.mechanisms[where.first].name,
                          report.suite.blocks[where.second].name, fmt::format("{}", indices.size()),
                          Indices(indices)});
  }
  return html::RenderTable(table);
}

/// Failures by solver, kind of target and verdict.
Markup Groups(const ComparisonReport& report) {
  struct Group {
    int count = 0;
    std::set<int> mechanisms;
  };
  std::map<std::tuple<SolverEntry, int, Verdict>, Group> groups;
  for (const Result& result : report.results) {
    if (!Failed(report, result)) continue;
    Group& group = groups[{result.solver, result.problem.block, result.verdict}];
    ++group.count;
    group.mechanisms.insert(result.problem.mechanism);
  }
  html::Table table;
  table.caption = "Failures by solver, kind of target and verdict.";
  table.columns = {{"Solver"}, {"Targets"}, {"Verdict"}, {"Problems", true}, {"Mechanisms"}};
  for (const auto& [key, group] : groups) {
    const auto& [solver, block, verdict] = key;
    std::string names;
    for (const int m : group.mechanisms) {
      names += fmt::format("{}{}", names.empty() ? "" : ", ", report.suite.mechanisms[m].name);
    }
    table.rows.push_back({SolverName(solver), report.suite.blocks[block].name,
                          std::string(NameOf(verdict)), fmt::format("{}", group.count), names});
  }
  return html::RenderTable(table);
}

std::vector<Markup> FailureRow(const ComparisonReport& report, const Result& r) {
  return {report.suite.mechanisms[r.problem.mechanism].name,
          report.suite.blocks[r.problem.block].name,
          fmt::format("{}", r.problem.index + 1),
          std::string(NameOf(r.verdict)),
          fmt::format("{}", r.iterations),
          Number(r.e2),
          Number(r.kkt),
          r.message};
}

/// One folded list per solver.
Markup Lists(const ComparisonReport& report) {
  Markup lists;
  for (const SolverEntry& solver : report.solvers) {
    html::Table table;
    table.columns = {{"Mechanism"},        {"Targets"},     {"No.", true}, {"Verdict"},
                     {"Iterations", true}, {"Loops", true}, {"KKT", true}, {"Reason"}};
    size_t failures = 0;
    for (const Result& result : report.results) {
      if (result.solver != solver || !Failed(report, result)) continue;
      if (++failures <= kMostRows) table.rows.push_back(FailureRow(report, result));
    }
    if (failures == 0) continue;
    Markup content = html::RenderTable(table);
    if (failures > kMostRows) {
      content += html::Paragraph(
          fmt::format("The first {} of {}; results.csv has them all.", kMostRows, failures));
    }
    lists += html::Details(SolverName(solver) + fmt::format(": {} failures", failures), content);
  }
  return lists;
}

/// What kept problems and solvers out of the count.
Markup LeftOut(const ComparisonReport& report) {
  std::map<std::string, int> reasons;
  for (const Result& r : report.results) {
    if (r.verdict == Verdict::kUnavailable) {
      ++reasons[fmt::format("{}: {}", r.solver.name(), r.message)];
    } else if (r.verdict == Verdict::kNotPosed && r.solver == report.solvers[0]) {
      ++reasons[fmt::format("{}, {}: {}", report.suite.mechanisms[r.problem.mechanism].name,
                            report.suite.blocks[r.problem.block].name, r.message)];
    }
  }
  if (reasons.empty()) return {};
  std::vector<Markup> items;
  for (const auto& [reason, count] : reasons) {
    items.push_back(fmt::format("{} ({} problems)", reason, count));
  }
  return html::Heading(3, "Not counted") + html::BulletList(items);
}

}  // namespace

Markup FailureSection(const ComparisonReport& report) {
  Markup section = html::Heading(2, "Failures");
  section += Unsolved(report);
  const bool none = std::none_of(report.results.begin(), report.results.end(),
                                 [&](const Result& r) { return Failed(report, r); });
  if (!none) section += Groups(report) + Lists(report);
  return section + LeftOut(report);
}

}  // namespace vmech
