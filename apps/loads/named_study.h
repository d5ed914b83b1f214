#pragma once

#include "vmech/studies/study.h"

namespace vmech {

/// RunStudy, whose errors name the study's file. @throws FileErrors, std::runtime_error.
StudyOutcome RunNamedStudy(const StudyFile& file, const LoadStudyOptions& options);

}  // namespace vmech
