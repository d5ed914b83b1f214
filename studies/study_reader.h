#pragma once

#include <filesystem>
#include <span>
#include <string_view>

#include "vmech/mechanisms/expressions/parameter_table.h"
#include "vmech/mechanisms/files/document.h"
#include "vmech/studies/study.h"

namespace vmech {

/// The version of the study format that this library reads: the value of the key `vmech_study`.
constexpr std::string_view kStudyFormat = "1.0";

/// Reads a study as docs/study-format.md describes it, with the mechanism and the tables that it
/// names, whose paths are relative to the study.
/// `settings` give parameters of the study or its mechanism other values.
/// @throws FileErrors with everything that is wrong in any of these files.
StudyFile ReadStudy(const std::filesystem::path& path,
                    std::span<const ParameterSetting> settings = {});

/// The same from a text; `path` is where the file would be.
StudyFile ParseStudy(std::string_view text, const std::filesystem::path& path,
                     std::span<const ParameterSetting> settings = {});

}  // namespace vmech
