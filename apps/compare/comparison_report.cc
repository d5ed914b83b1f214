#include "vmech/apps/compare/comparison_report.h"

#include <fmt/format.h>

#include <algorithm>

#include "vmech/apps/compare/report_sections.h"
#include "vmech/apps/html/page.h"
#include "vmech/apps/plot/style.h"
#include "vmech/comparison/statistics.h"

namespace vmech {
namespace {

using html::Markup;

/// The solver that does best on some blocks, for a headline: its share, and whose it is.
html::Tile BestTile(const ComparisonReport& report, const std::string& label,
                    const std::function<bool(const TargetBlock&)>& takes) {
  Tally best;
  std::vector<std::string> names;
  for (const SolverEntry& solver : report.solvers) {
    const Tally tally = TallyOf(report.suite, report.results, [&](const Result& r) {
      return r.solver == solver && takes(report.suite.blocks[r.problem.block]);
    });
    if (tally.problems == 0) continue;
    if (tally.share() > best.share()) names.clear();
    if (tally.share() >= best.share()) names.emplace_back(solver.name()), best = tally;
  }
  if (best.problems == 0) return {label, "–", "", "none solved"};
  const std::string whose = names.size() == 1 ? names[0]
                            : names.size() == report.solvers.size()
                                ? "every solver"
                                : fmt::format("{} solvers, {} among them", names.size(), names[0]);
  return {label, Percent(best.succeeded, best.problems), "",
          fmt::format("of {}: {}", best.problems, whose)};
}

Markup Header(const ComparisonReport& report) {
  const Suite& suite = report.suite;
  Markup header = html::Element("p", "Comparison of solvers", "eyebrow");
  header += html::Heading(1, suite.name);
  const size_t problems = ProblemsOf(suite).size();
  header += html::Element(
      "p",
      fmt::format("{} solvers on {} problems of {} mechanisms: the pose nearest to that of a hand, "
                  "with every loop closed.",
                  report.solvers.size(), problems, suite.mechanisms.size()),
      "lead");
  if (!suite.description.empty()) header += html::Paragraph(suite.description);
  const auto near = [](const TargetBlock& block) {
    return block.kind == TargetKind::kReachable && block.start == StartKind::kNear;
  };
  const auto far = [](const TargetBlock& block) {
    return block.kind == TargetKind::kReachable && block.start == StartKind::kFar;
  };
  const auto is = [](TargetKind kind) {
    return [kind](const TargetBlock& block) { return block.kind == kind; };
  };
  header +=
      html::Tiles({BestTile(report, "Best from near", near), BestTile(report, "Best from far", far),
                   BestTile(report, "Best out of reach", is(TargetKind::kUnreachable)),
                   BestTile(report, "Best on paths", is(TargetKind::kTracking))});
  return header;
}

Markup MethodSection(const ComparisonReport& report, std::string_view version) {
  const Suite& suite = report.suite;
  Markup section = html::Heading(2, "How this was found");
  section += html::Paragraph(
      "minimise ½ e₁ᵀ K e₁ subject to e₂(q) = 0 and the joint limits. e₁ leads from the grasp to "
      "the hand, lengths over the characteristic length, rotations in radians; e₂ is the error of "
      "the loops. Every solver has the same problem, the same start and the same stopping rule; "
      "what counts is measured at the configuration that it returns.");
  section += html::BulletList({
      fmt::format("Solved: loops closed to {:g} and the target reached to {:g}.",
                  suite.stopping.constraint_tolerance, suite.reach_tolerance),
      fmt::format("Unreachable: loops closed to the same, a KKT error of at most {:g}, and no "
                  "direction in which the distance to the target falls (second derivatives). For a "
                  "target that is out of reach this is success.",
                  suite.stopping.optimality_tolerance),
      "Local minimum: the same, but the target could have been reached.",
      "Saddle: stationary, but no minimum. Biased: loops open by the bias of a penalty.",
      "A path is solved if each of its targets is, each from the configuration of the one before, "
      "without a jump to another branch.",
      "Branch: own, if the configuration found is that from which the target was made, to 0.001; "
      "counted where the grasp tells the configuration.",
      fmt::format("At most {} iterations. Time: median of {} solves; paths once.",
                  suite.stopping.max_iterations, suite.repetitions),
      fmt::format("Random numbers from seed {}. vmech {}.", suite.seed, version),
  });
  return section;
}

}  // namespace

std::string RenderComparisonReport(const Suite& suite, const std::vector<Result>& results,
                                   std::string_view version) {
  const ComparisonReport report{suite, results, SolversOf(results)};
  Markup body = Header(report);
  body += SuccessSection(report);
  body += ProfileSection(report);
  body += TimeSection(report);
  body += AccuracySection(report);
  body += FailureSection(report);
  body += MethodSection(report, version);
  return html::RenderPage("Comparison: " + suite.name, body, plot::PlotStyleSheet());
}

}  // namespace vmech
