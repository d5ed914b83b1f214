#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "vmech/apps/compare/report_sections.h"
#include "vmech/apps/html/page.h"
#include "vmech/apps/plot/line_plot.h"
#include "vmech/apps/plot/style.h"
#include "vmech/comparison/profile.h"
#include "vmech/comparison/statistics.h"

namespace vmech {
namespace {

using html::Markup;

constexpr double kLargestRatio = 1e5;  // beyond it profiles are cut off

/// Colours repeat after plot::kPaletteSize; line styles tell those apart.
plot::LineStyle StyleOf(size_t series) {
  constexpr plot::LineStyle kStyles[] = {plot::LineStyle::kSolid, plot::LineStyle::kDashed,
                                         plot::LineStyle::kDotted};
  return kStyles[series / plot::kPaletteSize % 3];
}

/// A step function from x_min to x_max, in percent.
plot::Series Steps(std::string name, const PerformanceProfile::Curve& curve, double x_min,
                   double x_max, plot::LineStyle style) {
  plot::Series series{std::move(name), {x_min}, {100 * curve.At(x_min)}, style};
  for (size_t i = 0; i < curve.ratio.size(); ++i) {
    if (curve.ratio[i] <= x_min || curve.ratio[i] > x_max) continue;
    series.x.insert(series.x.end(), 2, curve.ratio[i]);
    series.y.push_back(series.y.back());
    series.y.push_back(100 * curve.share[i]);
  }
  series.x.push_back(x_max);
  series.y.push_back(series.y.back());
  return series;
}

plot::LinePlot StepPlot(std::string title, std::string x_title, double x_min, double x_max) {
  plot::LinePlot plot;
  plot.title = std::move(title);
  plot.x = {std::move(x_title), "", plot::ScaleType::kLog, x_min, x_max};
  plot.y = {"share of the problems", "%", plot::ScaleType::kLinear, 0, 100};
  plot.width = 960;
  plot.height = 400;
  return plot;
}

/// The fast path takes paths only, and has no place among those who take everything.
std::vector<SolverEntry> BackendsOf(const ComparisonReport& report) {
  std::vector<SolverEntry> solvers = report.solvers;
  std::erase_if(solvers, [](const SolverEntry& solver) { return !solver.backend(); });
  return solvers;
}

Markup Profile(const ComparisonReport& report, const std::string& title, const std::string& ratio,
               const std::function<double(const Result&)>& measure) {
  const std::vector<SolverEntry> solvers = BackendsOf(report);
  const PerformanceProfile profile = MakePerformanceProfile(CostsOf(
      report.suite, report.results, solvers, [](const Result&) { return true; }, measure));
  // A whole decade, so that the axis ends at a tick.
  const double largest = std::clamp(profile.largest_ratio, 10.0, kLargestRatio);
  const double x_max = std::pow(10, std::ceil(std::log10(largest)));
  plot::LinePlot plot = StepPlot(title, ratio, 1, x_max);
  for (size_t s = 0; s < profile.curves.size(); ++s) {
    plot.series.push_back(
        Steps(std::string(solvers[s].name()), profile.curves[s], 1, x_max, StyleOf(s)));
  }
  plot.description = title + ": share of the problems within a ratio of the best solver.";
  return html::Figure(plot::Draw(plot));
}

/// Share of the problems whose measure is at most x.
Markup Accuracy(const ComparisonReport& report, const std::string& title,
                const std::string& quantity, double tolerance,
                const std::function<double(const Result&)>& measure) {
  constexpr double kLeast = 1e-18, kMost = 1;
  plot::LinePlot plot = StepPlot(title, quantity, kLeast, kMost);
  for (size_t s = 0; s < report.solvers.size(); ++s) {
    std::vector<double> values;
    for (const Result& result : report.results) {
      if (result.solver != report.solvers[s] || !Counts(result)) continue;
      values.push_back(std::max(measure(result), kLeast));
    }
    if (values.empty()) continue;
    plot.series.push_back(Steps(std::string(report.solvers[s].name()),
                                CumulativeShare(std::move(values)), kLeast, kMost, StyleOf(s)));
  }
  plot.description = title + ".";
  return html::Figure(
      plot::Draw(plot),
      fmt::format("Share of all problems that end at or below. Asked for is {:g}.", tolerance));
}

std::string TimeInWords(double seconds) {
  if (!std::isfinite(seconds)) return "–";
  return seconds < 1e-3 ? plot::FormatSignificant(seconds * 1e6, 3) + " µs"
                        : plot::FormatSignificant(seconds * 1e3, 3) + " ms";
}

}  // namespace

Markup ProfileSection(const ComparisonReport& report) {
  Markup section = html::Heading(2, "Performance profiles");
  section += html::Paragraph(
      "For each solver, the share of all problems that it solves within a ratio of what the best "
      "solver needs for them (Dolan and Moré 2002). At the left, where the ratio is 1, stands how "
      "often it is the best; at the right, how much it solves at all.");
  section += Profile(report, "Time", "time, over that of the fastest solver",
                     [](const Result& r) { return std::max(r.time, 1e-9); });
  section += Profile(report, "Evaluations", "evaluations, over those of the most frugal solver",
                     [](const Result& r) { return std::max(r.evaluations, 1); });
  return section;
}

Markup AccuracySection(const ComparisonReport& report) {
  const StoppingRule& rule = report.suite.stopping;
  Markup section = html::Heading(2, "Accuracy");
  section += html::Paragraph(
      "Measured at the returned configuration, whatever the solver says of itself. Failures are "
      "among them; of a path the worst target counts.");
  section += Accuracy(report, "Closure of the loops",
                      "largest loop error, characteristic lengths and radians",
                      rule.constraint_tolerance, [](const Result& r) { return r.e2; });
  section += Accuracy(report, "Optimality", "KKT error, relative", rule.optimality_tolerance,
                      [](const Result& r) { return r.kkt; });
  return section;
}

Markup TimeSection(const ComparisonReport& report) {
  html::Table table;
  table.caption = "Median time of a solved target; of paths, per target.";
  table.columns = {{"Mechanism"}, {"coordinates", true}};
  for (const SolverEntry& solver : report.solvers) {
    table.columns.push_back({SolverName(solver), true});
  }
  for (size_t m = 0; m < report.suite.mechanisms.size(); ++m) {
    const SuiteMechanism& mechanism = report.suite.mechanisms[m];
    int freedoms = 0;
    for (const Joint& joint : mechanism.mechanism.joints) freedoms += FreedomsOf(joint.type);
    std::vector<Markup> row = {mechanism.name, fmt::format("{}", freedoms)};
    for (const SolverEntry& solver : report.solvers) {
      std::vector<double> times;
      for (const Result& r : report.results) {
        const bool counts = r.solver == solver && r.problem.mechanism == static_cast<int>(m);
        if (!counts || !Succeeded(r, report.suite.blocks[r.problem.block].kind)) continue;
        times.push_back(r.time / r.targets);
      }
      row.push_back(TimeInWords(MedianOf(times)));
    }
    table.rows.push_back(std::move(row));
  }
  return html::Heading(2, "Times") + html::RenderTable(table);
}

}  // namespace vmech
