#pragma once

#include <string>
#include <vector>

#include "vmech/dynamics/simulation/equations/constrained_motion.h"

namespace vmech {

// Motions that nothing with mass takes part in, as the spin of a massless rod. A force along one
// has no finite acceleration, and without a force there is nothing that tells how it goes on.

/// Why the last Accelerate of `motion` is no answer: a force, more than rounding, that acts along
/// such a motion. Names its joints, the force and what to do. Empty if there is none.
std::string DescribeUnresisted(const KinematicTree& tree, const ConstrainedMotion& motion);

/// A sentence about each of those that there are at the pose: what stands still because nothing
/// moves it.
std::vector<std::string> DescribeStanding(const KinematicTree& tree,
                                          const ConstrainedMotion& motion);

}  // namespace vmech
