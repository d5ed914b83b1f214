#pragma once

#include <span>
#include <string>

#include "vmech/mechanisms/expressions/parameter_table.h"
#include "vmech/mechanisms/files/document.h"

namespace vmech {

/// The block `parameters` of a mechanism or a study, and settings from outside of the file.

/// Declares every entry of the block; one of a name that the table has sets that parameter. Bare
/// numbers count in `units`. What is wrong with names and texts is reported at the node.
void ReadParameters(const Node& block, const CountingUnits& units, ParameterTable* table);

/// Sets parameters. `source` and the text of a setting stand for its place in messages, as in
/// "--set crank=60". @throws FileErrors for a name that the table has not, in `file`, and for a
/// text that is no expression.
void ApplySettings(std::span<const ParameterSetting> settings, const std::string& file,
                   const CountingUnits& units, ParameterTable* table);

/// Where a value stands, for what is wrong with it.
FileError PlaceOf(const Node& node);
/// "--set crank=60", as the file of an error.
std::string PlaceOf(const ParameterSetting& setting);

}  // namespace vmech
