#pragma once

#include <string>
#include <string_view>

#include "vmech/studies/study.h"

namespace vmech {

/// The report of `vmech loads` as one self-contained HTML page: headline numbers, loads of every
/// joint with plots, what statics can determine in words, bearings with the reasons for each
/// choice, how it moves, the drive, how the numbers were found and from what. `version` is that of
/// vmech, `date` the day on which it was computed; without one none is shown. The same input gives
/// the same bytes.
/// @throws std::invalid_argument if the study and its outcome do not belong together.
std::string RenderLoadReport(const StudyFile& file, const StudyOutcome& outcome,
                             std::string_view version, std::string_view date = "");

}  // namespace vmech
