#pragma once

#include <vector>

#include "vmech/dynamics/loads/pose/study_motion.h"

namespace vmech {

/// The motion at some of its poses.
Motion PartOf(const Motion& motion, const std::vector<size_t>& poses);

}  // namespace vmech
