#include "vmech/apps/loads/simulation_tables.h"

#include <fmt/format.h>

#include "vmech/mechanisms/freedoms.h"
#include "vmech/studies/csv_table.h"

namespace vmech {

std::string EnergiesTable(const SimulationResult& simulation) {
  std::string text = "t,kinetic,weight,springs,total,supplied,dissipated,error\n";
  for (size_t i = 0; i < simulation.size(); ++i) {
    const EnergySample& e = simulation.energies[i];
    text += fmt::format("{},{},{},{},{},{},{},{}\n", simulation.times[i], e.kinetic, e.weight,
                        e.springs, e.Total(), e.supplied, e.dissipated, e.error);
  }
  return text;
}

std::string EventsTable(const StudyFile& file, const SimulationResult& simulation) {
  std::string text = "t,kind,freedom,value,rate\n";
  for (const SimulationEvent& event : simulation.events) {
    const std::string freedom =
        event.at.joint < 0
            ? ""
            : NameOfFreedom(file.study.mechanism.joints[event.at.joint], event.at.freedom);
    text += fmt::format("{},{},{},{},{}\n", event.time, NameOf(event.kind), CsvCell(freedom),
                        event.value, event.rate);
  }
  return text;
}

}  // namespace vmech
