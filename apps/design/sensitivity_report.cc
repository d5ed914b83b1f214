#include "vmech/apps/design/sensitivity_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "vmech/apps/design/ranked.h"
#include "vmech/apps/html/page.h"
#include "vmech/apps/plot/bar_chart.h"
#include "vmech/apps/plot/scale.h"
#include "vmech/apps/plot/style.h"

namespace vmech {
namespace {

using html::Markup;

constexpr size_t kBars = 8;
constexpr double kNegligible = 5e-3;  // percent by a percent
constexpr double kRounding = 1e-9;    // of them: what is not moved at all

std::string Number(double value) {
  return plot::FormatSignificant(value, 4);
}

std::string WithUnit(double value, const std::string& unit) {
  return unit.empty() ? Number(value) : Number(value) + "\u00a0" + unit;
}

Markup Chart(const Sensitivities& result, const FigureSlopes& figure) {
  plot::BarChart chart;
  chart.title =
      fmt::format("{}: {}", figure.figure.name, WithUnit(figure.value, figure.figure.unit));
  chart.quantity = figure.pose < 0 ? "percent by a percent"
                                   : fmt::format("percent by a percent, at pose {}", figure.pose);
  for (const RankedParameter& r : RankParameters(result, figure, kBars, kNegligible)) {
    chart.bars.push_back({result.parameters[r.parameter].name, r.elasticity});
  }
  if (chart.bars.empty()) return html::Paragraph(chart.title + ": no parameter moves it.");
  chart.description =
      fmt::format("{} is moved most by {}", figure.figure.name, chart.bars.front().label);
  return html::Figure(plot::Draw(chart));
}

Markup Charts(const Sensitivities& result) {
  std::vector<Markup> charts, open;
  for (const FigureSlopes& figure : result.figures) {
    if (figure.slopes.empty()) {
      open.emplace_back(fmt::format("{}, {}: {}", figure.figure.name,
                                    WithUnit(figure.value, figure.figure.unit),
                                    figure.not_determined));
    } else {
      charts.push_back(Chart(result, figure));
    }
  }
  Markup section;
  for (size_t i = 0; i < charts.size(); i += 2) {
    const size_t end = std::min(i + 2, charts.size());
    section += html::FigureRow(
        {charts.begin() + static_cast<ptrdiff_t>(i), charts.begin() + static_cast<ptrdiff_t>(end)});
  }
  if (!open.empty()) {
    section += html::Heading(2, "Not determined by statics") + html::BulletList(open);
  }
  return section;
}

Markup Refused(const Sensitivities& result) {
  std::vector<Markup> reasons;
  for (const SharedRefusal& refusal : SharedRefusals(result)) {
    reasons.emplace_back(refusal.parameters + ": " + refusal.reason);
  }
  if (reasons.empty()) return {};
  return html::Heading(2, "Without a derivative") + html::BulletList(reasons);
}

Markup Slopes(const Sensitivities& result) {
  html::Table table;
  table.columns = {{"Figure"},
                   {"Parameter"},
                   {"Value", true},
                   {"Derivative", true},
                   {"Percent by a percent", true}};
  for (const FigureSlopes& figure : result.figures) {
    for (const RankedParameter& r :
         RankParameters(result, figure, result.parameters.size(), kRounding)) {
      const StudyParameter& parameter = result.parameters[r.parameter];
      table.rows.push_back({figure.figure.name, parameter.name,
                            WithUnit(parameter.value, parameter.unit),
                            WithUnit(figure.slopes[r.parameter],
                                     fmt::format("{}/{}", figure.figure.unit, parameter.unit)),
                            Number(r.elasticity)});
    }
  }
  return html::Details("All derivatives that are not zero", html::RenderTable(table));
}

}  // namespace

std::string RenderSensitivityReport(const StudyFile& file, const Sensitivities& result,
                                    std::string_view version, std::string_view date) {
  const Markup body =
      html::Heading(1, file.name + ": what matters") +
      html::Paragraph(fmt::format(
          "How the figures of the study go with the dimensions of its mechanism: exact derivatives "
          "at the design as it is. A bar of 2 says that a percent of the parameter moves the "
          "figure "
          "by two percent. The derivative of a peak is that of the pose that has it. vmech {}, {}.",
          version, date)) +
      Charts(result) + Refused(result) + Slopes(result);
  return html::RenderPage(file.name + ": sensitivities", body, plot::PlotStyleSheet());
}

}  // namespace vmech
