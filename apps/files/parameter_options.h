#pragma once

#include <span>
#include <string>
#include <vector>

#include "vmech/apps/console/option_error.h"
#include "vmech/mechanisms/expressions/parameter_table.h"
#include "vmech/mechanisms/files/file_errors.h"

namespace vmech {

/// The words behind `--set`, "crank=60", as settings. @throws OptionError for one without a name or
/// a value.
std::vector<ParameterSetting> ParseSettings(const std::vector<std::string>& words);

/// Are all these errors about settings, not about files?
bool AreOfSettings(const FileErrors& errors);

/// Reads a file with the parameters that the command line sets.
/// @throws OptionError if the file is right and a setting is wrong.
template <typename Read>
auto ReadWithSettings(const std::vector<std::string>& words, Read read) {
  const std::vector<ParameterSetting> settings = ParseSettings(words);
  try {
    return read(std::span<const ParameterSetting>(settings));
  } catch (const FileErrors& errors) {
    if (AreOfSettings(errors)) throw OptionError(errors.what());
    throw;
  }
}

}  // namespace vmech
