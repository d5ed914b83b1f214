#pragma once

#include "vmech/dynamics/loads/load_result.h"
#include "vmech/dynamics/loads/load_study.h"
#include "vmech/dynamics/loads/prepare_study.h"

namespace vmech {

/// Computes the loads of every joint at every pose of a study.
/// @throws std::invalid_argument for a study that contradicts itself, std::runtime_error with the
///         pose and its time where the motion cannot be followed (a dead centre, out of reach),
///         where it leaves limits at which it is to stop, where a load acts on a freedom that
///         nothing resists, or where `progress` has stopped the study.
LoadStudyResult RunLoadStudy(const LoadStudy& study, const LoadStudyOptions& options = {});

/// The same where the study has been prepared already.
LoadStudyResult RunLoadStudy(const LoadStudy& study, const PreparedStudy& prepared,
                             const LoadStudyOptions& options);

}  // namespace vmech
