#pragma once

#include "vmech/dynamics/simulation/equations/equations_of_motion.h"

namespace vmech {

/// Where the equations of motion are hard on an integrator: poses at which loops lose rank, and
/// motions that have long decayed. States are those of EquationsOfMotion::Slopes.

/// Is a mechanism, after a step [s], next to a singular pose, or does it creep up to one? Its
/// distance is the root of the pivot.
bool NearSingularPose(EquationsOfMotion& equations, double step);

/// Near a singular pose loops leave little more than rounding of how they bend there, and small
/// steps do not lead over it: one of Adams and Bashforth does, of a fraction of a millisecond, by
/// slopes behind it. Moves time and state, not beyond `end`; false, and nothing is moved, if there
/// is none to leap over.
bool LeapOverSingularPose(double end, EquationsOfMotion* equations, double* time, VectorXd* y);

/// The largest eigenvalue of df/dy, by a power iteration, if it is real and negative: its size
/// [1/s]; else 0.
double FastestDecay(double time, const VectorXd& y, EquationsOfMotion* equations);

}  // namespace vmech
