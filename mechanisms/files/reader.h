#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>

#include "vmech/mechanisms/expressions/parameter_table.h"
#include "vmech/mechanisms/files/document.h"
#include "vmech/mechanisms/files/mechanism_source.h"
#include "vmech/mechanisms/mechanism.h"

namespace vmech {

/// Reads a mechanism from a file: YAML or JSON as docs/file-format.md describes it, in any units;
/// the result is in SI. The anchors of a joint need not coincide in the file: that is the business
/// of the assembly step, and so is a loop that cannot be closed.
/// @throws FileErrors with everything that is wrong: what, where, and what to do.
Mechanism ReadMechanism(const std::filesystem::path& path);
/// The same with other values of parameters.
Mechanism ReadMechanism(const std::filesystem::path& path,
                        std::span<const ParameterSetting> settings);

/// The same from a text; `name` stands for the file in messages.
Mechanism ParseMechanism(std::string_view text, const std::string& name);

}  // namespace vmech
