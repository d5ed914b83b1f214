#include "vmech/apps/files/parameter_options.h"

#include <fmt/format.h>

#include <algorithm>

namespace vmech {

std::vector<ParameterSetting> ParseSettings(const std::vector<std::string>& words) {
  std::vector<ParameterSetting> settings;
  for (const std::string& word : words) {
    const size_t equals = word.find('=');
    if (equals == std::string::npos || equals == 0 || equals + 1 == word.size()) {
      throw OptionError(
          fmt::format("--set: {} is not of the form NAME=VALUE, as in crank=60", Quoted(word)));
    }
    settings.push_back({word.substr(0, equals), word.substr(equals + 1)});
  }
  return settings;
}

bool AreOfSettings(const FileErrors& errors) {
  return std::all_of(errors.errors().begin(), errors.errors().end(),
                     [](const FileError& error) { return error.file.starts_with("--set "); });
}

}  // namespace vmech
