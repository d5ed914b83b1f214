#pragma once

#include "vmech/apps/html/markup.h"
#include "vmech/apps/report/cycle.h"
#include "vmech/dynamics/loads/load_result.h"
#include "vmech/dynamics/loads/load_study.h"

namespace vmech {

/// How the mechanism moves: strokes and extreme positions, the time ratio, the transmission angle,
/// coordinate, rate and acceleration of every freedom as plots, the paths of the grasps.
html::Markup KinematicsSection(const LoadStudy& study, const LoadStudyResult& result,
                               const Cycle& cycle);

}  // namespace vmech
