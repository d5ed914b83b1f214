#pragma once

#include <filesystem>
#include <string_view>

#include "vmech/comparison/suite.h"

namespace vmech {

/// The version of the file format that this library reads: the value of the key `vmech_suite`.
constexpr std::string_view kSuiteFormat = "1.0";

/// Reads a suite (docs/suite-format.md) and the mechanisms that it names.
/// @throws FileErrors with everything that is wrong with any of them.
Suite ReadSuite(const std::filesystem::path& path);

/// The same from a text; mechanisms are looked for beside `path`.
Suite ParseSuite(std::string_view text, const std::filesystem::path& path);

}  // namespace vmech
