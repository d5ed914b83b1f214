#include "vmech/apps/report/simulation_section.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "vmech/apps/html/page.h"
#include "vmech/apps/plot/line_plot.h"
#include "vmech/apps/plot/scale.h"
#include "vmech/apps/report/certainty_words.h"
#include "vmech/mechanisms/freedoms.h"

namespace vmech {
namespace {

using html::Markup;

plot::Series SeriesOf(const char* name, const SimulationResult& simulation,
                      double (*value)(const EnergySample&)) {
  plot::Series series{name, simulation.times, {}};
  for (const EnergySample& energy : simulation.energies) series.y.push_back(value(energy));
  return series;
}

Markup EnergyPlot(const SimulationResult& simulation) {
  plot::LinePlot plot;
  plot.title = "Energies";
  plot.description = "Kinetic energy, weight, springs and their sum over time.";
  plot.x = {"time", "s"};
  plot.y = {"energy", "J"};
  plot.series = {
      SeriesOf("kinetic", simulation, [](const EnergySample& e) { return e.kinetic; }),
      SeriesOf("weight", simulation, [](const EnergySample& e) { return e.weight; }),
      SeriesOf("springs", simulation, [](const EnergySample& e) { return e.springs; }),
      SeriesOf("sum", simulation, [](const EnergySample& e) { return e.Total(); }),
      SeriesOf("supplied", simulation, [](const EnergySample& e) { return e.supplied; }),
      SeriesOf("dissipated", simulation, [](const EnergySample& e) { return e.dissipated; })};
  plot.series[3].line = plot::LineStyle::kDashed;
  return html::Figure(plot::Draw(plot));
}

std::string Coordinate(const StudyFile& file, const SimulationEvent& event) {
  const JointType type = file.study.mechanism.joints[event.at.joint].type;
  const bool turns = FreedomsOfType(type).rotates[event.at.freedom];
  constexpr double kDegrees = 57.29577951308232;
  return turns ? plot::FormatSignificant(kDegrees * event.value, 5) + "°"
               : plot::FormatSignificant(1e3 * event.value, 5) + " mm";
}

Markup EventTable(const StudyFile& file, const SimulationResult& simulation) {
  constexpr size_t kMost = 200;
  if (simulation.events.empty()) return html::Paragraph("No limit was hit and nothing stuck.");
  html::Table table;
  table.columns = {{"Time", true}, {"What"}, {"Joint"}, {"At", true}, {"Rate before", true}};
  for (size_t i = 0; i < std::min(kMost, simulation.events.size()); ++i) {
    const SimulationEvent& event = simulation.events[i];
    const bool of_joint = event.at.joint >= 0;
    table.rows.push_back(
        {plot::FormatSignificant(event.time, 6) + " s", NameOf(event.kind),
         of_joint ? NameOfFreedom(file.study.mechanism.joints[event.at.joint], event.at.freedom)
                  : "",
         of_joint ? Coordinate(file, event) : "",
         of_joint ? plot::FormatSignificant(event.rate, 4) : ""});
  }
  Markup text = html::RenderTable(table);
  const auto is_rebound = [](const SimulationEvent& event) {
    return event.kind == SimulationEvent::Kind::kRebound;
  };
  if (std::any_of(simulation.events.begin(), simulation.events.end(), is_rebound)) {
    text += html::Paragraph(
        "An impact is over in no time: the loads on this page do not hold the blows, whose force "
        "depends on how elastic the stops are.");
  }
  if (simulation.events.size() > kMost) {
    text += html::Paragraph(
        fmt::format("And {} more, in events.csv.", simulation.events.size() - kMost));
  }
  return text;
}

Markup Statistics(const SimulationResult& simulation) {
  const SimulationStatistics& s = simulation.statistics;
  double error = 0;
  for (const EnergySample& energy : simulation.energies) {
    error = std::max(error, std::abs(energy.error));
  }
  return html::Paragraph(fmt::format(
      "By the method '{}': {} steps, {} evaluations of the accelerations, {} failures of the error "
      "test, {} iterations, {} returns to the loops in mid-run, {} restarts, in {} s. The loops "
      "drifted by {} at most before they were closed again, to {} in the results. The energy that "
      "cannot be accounted for is {} J at most.",
      NameOf(s.method), s.steps, s.evaluations, s.error_test_failures, s.nonlinear_iterations,
      s.projections, s.restarts, plot::FormatSignificant(s.seconds, 2),
      plot::FormatSignificant(s.largest_drift, 2), plot::FormatSignificant(s.largest_closure, 2),
      plot::FormatSignificant(error, 2)));
}

}  // namespace

Markup SimulationSection(const StudyFile& file, const SimulationResult& simulation) {
  Markup text = html::Heading(2, "The simulation");
  const bool whole = simulation.status == SimulationStatus::kFinished ||
                     simulation.status == SimulationStatus::kReached;
  text += whole ? html::Paragraph(simulation.message)
                : html::Notice(simulation.message, html::Tone::kBad);
  return text + EnergyPlot(simulation) + html::Heading(3, "Events") + EventTable(file, simulation) +
         html::Heading(3, "How it was computed") + Statistics(simulation);
}

}  // namespace vmech
