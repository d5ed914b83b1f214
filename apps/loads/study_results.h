#pragma once

#include <string_view>

#include "vmech/apps/files/result_folder.h"
#include "vmech/studies/study.h"

namespace vmech {

/// Writes all tables of a study's outcome, its summary and its report, and commits them.
/// @throws FileErrors if they cannot be written.
void WriteStudyResults(const StudyFile& file, const StudyOutcome& outcome, std::string_view version,
                       int threads, ResultFolder* folder);

/// @throws FileErrors with every warning, if there are any.
void RequireNoWarning(const StudyFile& file, const StudyOutcome& outcome);

/// Do the bearings do what is asked of them?
bool BearingsMet(const StudyOutcome& outcome);

}  // namespace vmech
