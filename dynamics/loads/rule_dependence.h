#pragma once

#include <vector>

#include "vmech/dynamics/loads/pose/study_motion.h"
#include "vmech/dynamics/loads/prepare_study.h"
#include "vmech/dynamics/reactions/certainty.h"

namespace vmech {

/// What changes when the choices change that are the user's: the stiffnesses, length scales and
/// rules that settle what statics leaves open, and the weights of a hand. Friction under a load
/// that statics does not determine, and a hand whose wrench it leaves open, carry the doubt on to
/// all that depends on them; no null space tells how far. So the loads are found again with other
/// choices, and what is not the same is not certain.
struct RuleDependence {
  std::vector<std::array<bool, 6>> joints;  ///< per joint and component, as JointCertainty
  std::vector<bool> drives;                 ///< the force of each drive
};

/// Judged at some poses of a motion. Needed where friction depends on loads, or a hand drives; for
/// other studies the null space of JudgeCertainty says as much.
RuleDependence FindRuleDependence(const PreparedStudy& prepared, const Motion& motion,
                                  const std::vector<size_t>& poses);

}  // namespace vmech
