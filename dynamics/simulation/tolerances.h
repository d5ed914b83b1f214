#pragma once

#include <vector>

#include "vmech/base/eigen.h"
#include "vmech/dynamics/simulation/prepared_simulation.h"
#include "vmech/dynamics/simulation/simulation.h"
#include "vmech/kinematics/tree/kinematic_tree.h"

namespace vmech {

// What a tolerance, which has no unit, means for a state of EquationsOfMotion::Slopes.

/// [nq + nv + 2] Absolute tolerances of a state: coordinates and rates in radians and
/// characteristic lengths. Energies count where drives prescribe motions, which then take no steps
/// of their own.
std::vector<double> AbsoluteTolerances(const PreparedSimulation& prepared, double tolerance);

/// How far loops may miss each other before a state `y` is brought back on them: steps of an
/// integrator drift by about their tolerance, which is more of coordinates that have grown large.
/// To bring each of them back would make it begin anew each time, of lowest order.
double LargestDrift(const SimulationOptions& options, const KinematicTree& tree, const VectorXd& y);

}  // namespace vmech
