#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "vmech/mechanisms/expressions/parameter_table.h"
#include "vmech/mechanisms/files/mechanism_source.h"
#include "vmech/mechanisms/mechanism.h"

namespace vmech {

/// A mechanism that was read, with what its parameters are.
struct ParametricMechanism {
  Mechanism mechanism;
  std::vector<StatedParameter> parameters;  ///< in the order of the file
};

/// From a text, with other values of its parameters; `name` stands for the file in messages.
/// @throws FileErrors with everything that is wrong with the text or the settings.
ParametricMechanism ReadParametric(std::string_view text, const std::string& name,
                                   std::span<const ParameterSetting> settings);

/// Words such as "crank=60" or "load=1 kN" as settings.
/// @throws std::invalid_argument for one without a name or a value.
std::vector<ParameterSetting> SettingsOf(std::span<const std::string> words);

}  // namespace vmech
