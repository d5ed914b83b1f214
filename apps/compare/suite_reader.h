#pragma once

#include <filesystem>
#include <span>
#include <string_view>

#include "vmech/comparison/suite.h"
#include "vmech/mechanisms/expressions/parameter_table.h"

namespace vmech {

/// The version of the file format that this library reads: the value of the key `vmech_suite`.
constexpr std::string_view kSuiteFormat = "1.0";

/// Reads a suite (docs/suite-format.md) and the mechanisms that it names.
/// `settings` give parameters of those that have them other values.
/// @throws FileErrors with everything that is wrong with any of them, and for a setting of a
/// parameter that none of them has.
Suite ReadSuite(const std::filesystem::path& path, std::span<const ParameterSetting> settings = {});

/// The same from a text; mechanisms are looked for beside `path`.
Suite ParseSuite(std::string_view text, const std::filesystem::path& path,
                 std::span<const ParameterSetting> settings = {});

}  // namespace vmech
