#pragma once

#include <span>
#include <vector>

#include "vmech/base/dual.h"
#include "vmech/dynamics/bearings/arrangement.h"
#include "vmech/dynamics/bearings/bearing.h"

namespace vmech {

/// A duty cycle (DutyCycle) with the slopes of its numbers.
struct DutySlopes {
  std::vector<Dual> duration, speed;  ///< of each sample [s], [rad/s]
  std::vector<Wrench<Dual>> wrench;   ///< of each sample, as DutyCycle
};

/// L_nh = a1 L10h [h] at a reliability [%] of the bearing at a position of the arrangement, as
/// BearingRating::modified_life_hours, and its derivative; infinite without load or rotation.
Dual LifeHours(const Bearing& bearing, const Arrangement& arrangement, size_t position,
               const DutySlopes& duty, double reliability);

}  // namespace vmech
