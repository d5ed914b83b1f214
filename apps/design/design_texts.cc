#include "vmech/apps/design/design_texts.h"

#include <fmt/format.h>

#include <cmath>
#include <iterator>
#include <vector>

#include "vmech/apps/html/page.h"
#include "vmech/apps/plot/scale.h"
#include "vmech/studies/csv_table.h"

namespace vmech {
namespace {

using html::Markup;

/// A line of what came of a design.
struct DesignRow {
  std::string kind, name, unit;
  double before = 0, after = 0;
  double lower = -INFINITY, upper = INFINITY;
  double gain = 0;
};

std::vector<DesignRow> RowsOf(const DesignTask& task, const DesignResult& result) {
  std::vector<DesignRow> rows{
      {"objective", task.objective.name, task.objective.unit, result.before[0], result.after[0]}};
  for (size_t i = 0; i < task.constraints.size(); ++i) {
    const DesignConstraint& c = task.constraints[i];
    rows.push_back({"constraint", c.figure.name, c.figure.unit, result.before[i + 1],
                    result.after[i + 1], c.at_least ? c.limit : -INFINITY,
                    c.at_least ? INFINITY : c.limit, std::abs(result.gain_by_limit[i])});
  }
  for (size_t k = 0; k < task.variables.size(); ++k) {
    const DesignVariable& v = task.variables[k];
    rows.push_back({"variable", v.parameter.name, v.parameter.unit, v.parameter.value,
                    result.values[k], v.lower, v.upper, std::abs(result.gain_by_bound[k])});
  }
  return rows;
}

std::string Number(double value) {
  return plot::FormatSignificant(value, 5);
}

std::string Range(const DesignRow& row) {
  if (row.kind == "objective") return "";
  if (std::isinf(row.lower)) return "<= " + Number(row.upper);
  if (std::isinf(row.upper)) return ">= " + Number(row.lower);
  return Number(row.lower) + " .. " + Number(row.upper);
}

std::string Goal(const DesignTask& task) {
  return (task.maximise ? "as large as can be: " : "as small as can be: ") + task.objective.name;
}

/// What would give more: "1 N m for each mm".
std::string Gain(const DesignTask& task, const DesignRow& row) {
  if (row.gain == 0) return "";
  return fmt::format("binds; {} {} for each {}", Number(row.gain), task.objective.unit,
                     row.unit.empty() ? "unit" : row.unit);
}

std::string Verdict(const DesignResult& result) {
  if (!result.feasible) {
    return "No design was found that keeps what it must; this one comes closest.";
  }
  constexpr double kMuch = 0.01;  // of the objective
  return fmt::format(
      "{} designs were looked at. What is left to gain is, by the slope at the best one, {:.1e} of "
      "the objective over the range of a parameter.{}",
      result.evaluations, result.optimality,
      result.optimality > kMuch ? " The search may have ended short of it: go on from this design, "
                                  "with other bounds, --starts or another --method."
                                : "");
}

std::string Cell(double value) {
  return std::isfinite(value) ? fmt::format("{}", value) : "";
}

}  // namespace

std::string PrintedDesign(const StudyFile& file, const DesignTask& task,
                          const DesignResult& result) {
  std::string text;
  auto out = std::back_inserter(text);
  fmt::format_to(out, "{}: {}\n\n", file.name, Goal(task));
  for (const DesignRow& row : RowsOf(task, result)) {
    fmt::format_to(out, "  {:<28} {:>12} -> {:<12} {:<4} {:<16} {}\n", row.name, Number(row.before),
                   Number(row.after), row.unit, Range(row), Gain(task, row));
  }
  fmt::format_to(out, "\n{}\n", Verdict(result));
  return text;
}

std::string DesignTable(const DesignTask& task, const DesignResult& result) {
  std::string text = "kind,name,unit,before,after,lower,upper,gain\n";
  auto out = std::back_inserter(text);
  for (const DesignRow& row : RowsOf(task, result)) {
    fmt::format_to(out, "{},{},{},{},{},{},{},{}\n", row.kind, CsvCell(row.name), row.unit,
                   row.before, row.after, Cell(row.lower), Cell(row.upper), row.gain);
  }
  return text;
}

std::string RenderDesignReport(const StudyFile& file, const DesignTask& task,
                               const DesignResult& result, std::string_view version,
                               std::string_view date) {
  html::Table table;
  table.columns = {{""},     {"Before", true}, {"After", true},
                   {"Unit"}, {"Asked"},        {"What would give more"}};
  for (const DesignRow& row : RowsOf(task, result)) {
    table.rows.push_back(
        {row.name, Number(row.before), Number(row.after), row.unit, Range(row), Gain(task, row)});
  }
  html::Table starts;
  starts.columns = {{"Start"}, {"Objective", true}, {"Keeps what it must"}, {"Ended by"}};
  for (size_t i = 0; i < result.runs.size(); ++i) {
    const DesignRun& run = result.runs[i];
    starts.rows.push_back({fmt::format("{}", i + 1), Number(run.objective),
                           run.feasible ? "yes" : "no", run.message});
  }
  const html::Tone tone = result.feasible ? html::Tone::kGood : html::Tone::kBad;
  const Markup body = html::Heading(1, file.name + ": a better design") +
                      html::Paragraph(fmt::format("{}. vmech {}, {}.", Goal(task), version, date)) +
                      html::Notice(Verdict(result), tone) + html::RenderTable(table) +
                      html::Heading(2, "Starts") + html::RenderTable(starts);
  return html::RenderPage(file.name + ": design", body);
}

}  // namespace vmech
