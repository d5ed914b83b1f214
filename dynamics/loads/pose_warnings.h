#pragma once

#include "vmech/dynamics/loads/load_result.h"
#include "vmech/dynamics/loads/pose/load_model.h"
#include "vmech/dynamics/loads/pose/study_motion.h"

namespace vmech {

/// The force along an idle freedom [N], [N m] below which it counts as none.
double RoundingAlongIdle(const LoadModel& model, double largest_force);

/// Warns of what sets an idle freedom moving: that makes another motion than the one which is
/// taken.
void WarnOfDrivenIdle(const LoadModel& model, double largest_force, LoadStudyResult* result);

/// Finds the poses at dead centres and warns of them, and of those beside one, where accelerations
/// are quotients of small differences.
void FindSingularPoses(const LoadModel& model, const Motion& motion, LoadStudyResult* result);

}  // namespace vmech
