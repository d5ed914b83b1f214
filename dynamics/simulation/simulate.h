#pragma once

#include "vmech/dynamics/simulation/simulation.h"
#include "vmech/dynamics/simulation/simulation_result.h"

namespace vmech {

/// Lets a mechanism move by its own dynamics: an open or closed one, with any number of loops and
/// redundant equations, from a consistent start to the last of the times.
///
///   M v' + h = forces - C' mu,   C v' + bias = 0,   v = N s:
///   (N'M N) s' = N' (forces - h - M a),   v' = a + N s',   C a + bias = 0
///
/// by CVODES on all coordinates of the tree, which are projected in the metric of M: velocities
/// wherever accelerations are computed, positions where they have drifted and in every result. Dry
/// friction sticks and slips, and limits rebound, at times that are found as roots.
///
/// @throws std::invalid_argument as RequireValid and SimulationOptions::Validate,
///         std::runtime_error if the loops cannot be closed, or if SUNDIALS is not there, naming
///         what to install. What goes wrong later is in the result's status and message, with all
///         that was computed before.
SimulationResult Simulate(const Simulation& simulation, const SimulationOptions& options = {});

}  // namespace vmech
