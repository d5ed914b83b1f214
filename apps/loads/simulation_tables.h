#pragma once

#include <string>

#include "vmech/studies/study.h"

namespace vmech {

/// The tables that only a simulation has, as the text of CSV files in SI units.

/// t, kinetic, weight, springs, total, supplied, dissipated, error [J]: as EnergySample.
std::string EnergiesTable(const SimulationResult& simulation);

/// t, kind, freedom, value, rate: as SimulationEvent, one row for each.
std::string EventsTable(const StudyFile& file, const SimulationResult& simulation);

}  // namespace vmech
