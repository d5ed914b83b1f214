#pragma once

#include <span>
#include <vector>

#include "vmech/base/tape/tape.h"
#include "vmech/dynamics/bearings/arrangement.h"
#include "vmech/dynamics/bearings/bearing.h"

namespace vmech {

/// A duty cycle (DutyCycle) with the slopes of its numbers.
struct DutySlopes {
  std::vector<Taped> duration, speed;  ///< of each sample [s], [rad/s]
  std::vector<Wrench<Taped>> wrench;   ///< of each sample, as DutyCycle
};

/// An arrangement (Arrangement) and the reliability asked of it, with the slopes of their numbers.
struct ArrangementSlopes {
  std::vector<Taped> positions;  ///< as Arrangement [m]
  int locating = 0;              ///< as Arrangement
  Taped reliability;             ///< [%]
};

/// L_nh = a1 L10h [h] of the bearing at a position of the arrangement, as
/// BearingRating::modified_life_hours, and its derivative; infinite without load or rotation.
Taped LifeHours(const Bearing& bearing, const ArrangementSlopes& arrangement, size_t position,
                const DutySlopes& duty);

}  // namespace vmech
