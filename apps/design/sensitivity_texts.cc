#include "vmech/apps/design/sensitivity_texts.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "vmech/apps/design/ranked.h"
#include "vmech/base/text/number_text.h"
#include "vmech/studies/csv_table.h"

namespace vmech {
namespace {

constexpr size_t kShown = 5;          // parameters of a figure
constexpr double kNegligible = 5e-3;  // percent by a percent
constexpr double kWidestBar = 24;     // characters

std::string PlaceOfPeak(const FigureSlopes& figure) {
  return figure.pose < 0 ? "" : fmt::format(" at pose {}", figure.pose);
}

void PrintFigure(const Sensitivities& result, const FigureSlopes& figure,
                 std::back_insert_iterator<std::string> out) {
  fmt::format_to(out, "\n  {}  {:.5g} {}{}\n", figure.figure.name, figure.value, figure.figure.unit,
                 PlaceOfPeak(figure));
  if (figure.slopes.empty()) {
    fmt::format_to(out, "    not determined by statics: {}\n", figure.not_determined);
    return;
  }
  const auto ranked = RankParameters(result, figure, kShown, kNegligible);
  if (ranked.empty()) fmt::format_to(out, "    no parameter moves it\n");
  const double most = ranked.empty() ? 1 : std::abs(ranked[0].elasticity);
  for (const RankedParameter& r : ranked) {
    const auto bar = static_cast<size_t>(std::ceil(kWidestBar * std::abs(r.elasticity) / most));
    fmt::format_to(out, "    {:<28} {:>+8.3f}  {}\n", result.parameters[r.parameter].name,
                   r.elasticity, std::string(bar, r.elasticity < 0 ? '-' : '+'));
  }
}

/// A number of a table; nothing where there is none.
std::string Cell(double value) {
  return std::isfinite(value) ? fmt::format("{}", value) : "";
}

}  // namespace

std::string PrintedSensitivities(const StudyFile& file, const Sensitivities& result) {
  std::string text;
  auto out = std::back_inserter(text);
  fmt::format_to(out, "{}: percent of a figure by a percent of a parameter\n", file.name);
  for (const FigureSlopes& figure : result.figures) PrintFigure(result, figure, out);
  const std::vector<SharedRefusal> refusals = SharedRefusals(result);
  if (!refusals.empty()) fmt::format_to(out, "\nWithout a derivative:\n");
  for (const SharedRefusal& refusal : refusals) {
    fmt::format_to(out, "  {}: {}\n", refusal.parameters, refusal.reason);
  }
  return text;
}

std::string SensitivityTable(const Sensitivities& result) {
  std::string text =
      "figure,unit,value,parameter,parameter_unit,parameter_value,slope,elasticity\n";
  auto out = std::back_inserter(text);
  for (const FigureSlopes& figure : result.figures) {
    for (size_t p = 0; p < result.parameters.size(); ++p) {
      const StudyParameter& parameter = result.parameters[p];
      const double slope = figure.slopes.empty() ? NAN : figure.slopes[p];
      fmt::format_to(out, "{},{},{},{},{},{},{},{}\n", CsvCell(figure.figure.name),
                     figure.figure.unit, figure.value, CsvCell(parameter.name), parameter.unit,
                     parameter.value, Cell(slope), Cell(figure.Elasticity(p, parameter)));
    }
  }
  return text;
}

}  // namespace vmech
