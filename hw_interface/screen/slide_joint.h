#pragma once

#include "vmech/mechanisms/mechanism.h"

namespace vmech {

/// Where a joint came to.
struct SlideResult {
  Mechanism mechanism;   ///< assembled there: its start values are those of the pose
  bool stopped = false;  ///< before the wanted value: a limit, or the end of what loops allow
};

/// Moves one freedom of an assembled mechanism's joint to `value` [m] or [rad] with its loops
/// closed, by small steps on the same assembly branch; stops before a step that leads a joint
/// beyond a limit, or to no closed pose nearby. The other freedoms move as little as they can.
/// @throws std::invalid_argument for a spherical joint, whose freedoms have no coordinates of their
///         own.
SlideResult SlideJoint(const Mechanism& assembled, int joint, int freedom, double value);

}  // namespace vmech
