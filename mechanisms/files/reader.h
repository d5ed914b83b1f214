#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "vmech/mechanisms/files/document.h"
#include "vmech/mechanisms/mechanism.h"

namespace vmech {

/// The version of the file format that this library reads: the value of the key `vmech`.
constexpr std::string_view kMechanismFormat = "1.0";

/// Reads a mechanism from a file: YAML or JSON as docs/file-format.md describes it, in any units;
/// the result is in SI. The anchors of a joint need not coincide in the file: that is the business
/// of the assembly step, and so is a loop that cannot be closed.
/// @throws FileErrors with everything that is wrong: what, where, and what to do.
Mechanism ReadMechanism(const std::filesystem::path& path);

/// The same from a text; `name` stands for the file in messages.
Mechanism ParseMechanism(std::string_view text, const std::string& name);

}  // namespace vmech
