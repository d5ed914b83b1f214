// How near simulations come to what is known of them, with which steps and in which time: the table
// of docs/simulate.md.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "reference_cases.h"
#include "simulated.h"

namespace vmech {
namespace {

void PrintRow(const ReferenceCase& c) {
  SimulationOptions options = Tight(c.tolerance);
  const SimulationResult result = Simulate(c.simulation, options);
  double error = 0, allowed = 0;
  for (const ReferenceValue& known : c.values) {
    const double here = std::abs(known.value(result, known.row) - known.expected);
    if (here / known.allowed <= error / std::max(allowed, 1e-300)) continue;
    error = here;
    allowed = known.allowed;
  }
  options.loads = false;
  double seconds = result.statistics.seconds;
  for (int i = 0; i < 3; ++i) {
    seconds = std::min(seconds, Simulate(c.simulation, options).statistics.seconds);
  }
  const SimulationStatistics& s = result.statistics;
  fmt::print("| {} | {} | {:.0e} | {:.1e} of {:.0e} | {:.1e} | {} | {} | {:.3g} |\n", c.name,
             c.source, c.tolerance, error, allowed, EnergyError(result), s.steps, s.evaluations,
             1e3 * seconds);
}

}  // namespace
}  // namespace vmech

int main() {
  fmt::print(
      "| case | source | tolerance | error, of what is asked | energy | steps | evaluations | ms "
      "|\n|---|---|---|---|---|---|---|---|\n");
  for (const vmech::ReferenceCase& c : vmech::ReferenceCases()) vmech::PrintRow(c);
}
