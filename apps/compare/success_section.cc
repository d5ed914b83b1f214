#include <fmt/format.h>

#include <cmath>

#include "vmech/apps/compare/report_sections.h"
#include "vmech/apps/html/page.h"
#include "vmech/comparison/statistics.h"

namespace vmech {
namespace {

using html::Markup;

/// The share that succeeded, and of how many.
Markup Share(const Tally& tally) {
  if (tally.problems == 0) return "–";
  Markup share = Percent(tally.succeeded, tally.problems);
  if (tally.succeeded == tally.problems) share = html::Element("strong", share);
  return share;
}

std::string InWords(const TargetBlock& block) {
  switch (block.kind) {
    case TargetKind::kReachable:
      return block.start == StartKind::kFar
                 ? "targets that can be reached, from configurations that have nothing to do with "
                   "them"
                 : fmt::format("targets that can be reached, from {:g} away", block.start_distance);
    case TargetKind::kUnreachable:
      return fmt::format(
          "targets {:g} off a pose, in a direction in which the grasp cannot go: "
          "asked for is the nearest pose",
          block.offset);
    case TargetKind::kSingular:
      return fmt::format(
          "targets near which the mechanism stops the grasp: a smallest singular "
          "value of {:g} or less",
          block.closeness);
    case TargetKind::kDeadCentre:
      return fmt::format(
          "paths of {} targets, {:g} apart, through a pose at which a joint turns "
          "back",
          block.steps, block.step);
    case TargetKind::kTracking:
      return fmt::format("paths of {} targets, {:g} apart", block.steps, block.step);
  }
  return "";
}

Markup BlockLegend(const ComparisonReport& report) {
  std::vector<Markup> items;
  for (size_t b = 0; b < report.suite.blocks.size(); ++b) {
    const TargetBlock& block = report.suite.blocks[b];
    const Tally all = TallyOf(report.suite, report.results, [&](const Result& r) {
      return r.problem.block == static_cast<int>(b) && r.solver == report.solvers[0];
    });
    items.push_back(html::Element("strong", block.name) +
                    fmt::format(" ({}): {}", all.problems, InWords(block)));
  }
  return html::BulletList(items);
}

html::Table ByBlock(const ComparisonReport& report) {
  html::Table table;
  table.caption = "Problems solved, by kind of target. Bold: all of them.";
  table.columns = {{"Solver"}};
  for (const TargetBlock& block : report.suite.blocks) table.columns.push_back({block.name, true});
  for (const SolverEntry& solver : report.solvers) {
    std::vector<Markup> row = {SolverName(solver)};
    for (size_t b = 0; b < report.suite.blocks.size(); ++b) {
      row.push_back(Share(TallyOf(report.suite, report.results, [&](const Result& r) {
        return r.solver == solver && r.problem.block == static_cast<int>(b);
      })));
    }
    table.rows.push_back(std::move(row));
  }
  return table;
}

html::Table ByMechanism(const ComparisonReport& report) {
  html::Table table;
  table.caption = "Problems solved, all kinds together, by mechanism.";
  table.columns = {{"Mechanism"}};
  for (const SolverEntry& solver : report.solvers) {
    table.columns.push_back({SolverName(solver), true});
  }
  for (size_t m = 0; m < report.suite.mechanisms.size(); ++m) {
    std::vector<Markup> row = {report.suite.mechanisms[m].name};
    for (const SolverEntry& solver : report.solvers) {
      row.push_back(Share(TallyOf(report.suite, report.results, [&](const Result& r) {
        return r.solver == solver && r.problem.mechanism == static_cast<int>(m);
      })));
    }
    table.rows.push_back(std::move(row));
  }
  return table;
}

/// Of what was solved, how much on the configuration that the target was made from; of paths, how
/// many single targets were reached and how often the branch was left.
html::Table Branches(const ComparisonReport& report) {
  html::Table table;
  table.caption =
      "Branches: of the solved problems whose grasp tells the configuration, how many ended at the "
      "one that the target was made from. Paths: single targets reached, and jumps to another "
      "branch.";
  table.columns = {{"Solver"}};
  for (const TargetBlock& block : report.suite.blocks) table.columns.push_back({block.name, true});
  for (const SolverEntry& solver : report.solvers) {
    std::vector<Markup> row = {SolverName(solver)};
    for (size_t b = 0; b < report.suite.blocks.size(); ++b) {
      const Tally tally = TallyOf(report.suite, report.results, [&](const Result& r) {
        return r.solver == solver && r.problem.block == static_cast<int>(b);
      });
      if (report.suite.blocks[b].is_path()) {
        row.push_back(
            tally.targets == 0
                ? std::string("–")
                : fmt::format("{}, {} jumps", Percent(tally.reached, tally.targets), tally.jumps));
      } else {
        const int told = tally.own + tally.other;
        row.push_back(told == 0 ? std::string("–") : Percent(tally.own, told));
      }
    }
    table.rows.push_back(std::move(row));
  }
  return table;
}

}  // namespace

std::string Percent(int part, int whole) {
  if (part == whole) return "100 %";
  const double tenths = std::floor(1000.0 * part / whole);
  return fmt::format("{:.1f} %", tenths / 10);
}

Markup SolverName(SolverEntry solver) {
  std::string name;
  for (const char c : solver.name()) {
    name += c;
    if (c == '_') name += "\u200B";
  }
  return name;
}

Markup SuccessSection(const ComparisonReport& report) {
  Markup section = html::Heading(2, "Who solves what");
  section += BlockLegend(report);
  section += html::RenderTable(ByBlock(report));
  section += html::RenderTable(Branches(report));
  section += html::RenderTable(ByMechanism(report));
  return section;
}

}  // namespace vmech
