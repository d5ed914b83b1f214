#include "vmech/bindings/shared/parametric.h"

#include <stdexcept>
#include <utility>

#include "vmech/mechanisms/files/parameters.h"

namespace vmech {

ParametricMechanism ReadParametric(std::string_view text, const std::string& name,
                                   std::span<const ParameterSetting> settings) {
  MechanismSource source(text, name);
  ApplySettings(settings, name, source.units(), &source.parameters());
  Mechanism mechanism = source.Read();
  return {std::move(mechanism), source.stated()};
}

std::vector<ParameterSetting> SettingsOf(std::span<const std::string> words) {
  std::vector<ParameterSetting> settings;
  for (const std::string& word : words) {
    const size_t equals = word.find('=');
    if (equals == std::string::npos || equals == 0 || equals + 1 == word.size()) {
      throw std::invalid_argument("settings: '" + word +
                                  "' is not of the form NAME=VALUE, as in crank=60");
    }
    settings.push_back({word.substr(0, equals), word.substr(equals + 1)});
  }
  return settings;
}

}  // namespace vmech
