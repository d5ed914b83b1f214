#pragma once

#include <functional>
#include <memory_resource>

#include "vmech/dynamics/loads/pose/study_motion.h"
#include "vmech/dynamics/loads/prepare_study.h"

namespace vmech {

/// Follows the motion from pose to pose on one assembly branch. Poses come from the loop equations;
/// between them the drive moves in smaller steps where a full one would be too long to be sure of
/// the branch. `goes_on` is asked now and then; false stops it. The motion's arrays lie in
/// `memory`, which must outlive them; those of its copies do not.
/// @throws std::runtime_error naming pose and time where the motion cannot be followed, or where it
/// was stopped.
Motion TrackMotion(const LoadStudy& study, const PreparedStudy& prepared, double closure_tolerance,
                   const std::function<bool()>& goes_on = {},
                   std::pmr::memory_resource* memory = std::pmr::get_default_resource());
/// What the arrays of that motion take [bytes].
size_t BytesOfMotion(const LoadStudy& study, const KinematicTree& tree);

}  // namespace vmech
