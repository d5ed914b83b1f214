#pragma once

#include <functional>

#include "vmech/dynamics/loads/pose/study_motion.h"
#include "vmech/dynamics/loads/prepare_study.h"

namespace vmech {

/// Follows the motion from pose to pose on one assembly branch. Poses come from the loop equations;
/// between them the drive moves in smaller steps where a full one would be too long to be sure of
/// the branch. `goes_on` is asked now and then; false stops it.
/// @throws std::runtime_error naming pose and time where the motion cannot be followed, or where it
/// was stopped.
Motion TrackMotion(const LoadStudy& study, const PreparedStudy& prepared, double closure_tolerance,
                   const std::function<bool()>& goes_on = {});

}  // namespace vmech
