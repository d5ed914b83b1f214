#pragma once

#include <functional>
#include <vector>

#include "vmech/dynamics/loads/load_result.h"
#include "vmech/dynamics/simulation/simulation.h"

namespace vmech {

/// A motion as the table of a simulation, or of a load study, has it: all freedoms of all joints at
/// some times. Coordinates, rates and accelerations are those of LoadArrays.
struct JointHistory {
  std::vector<double> times;                            ///< [times] increasing [s]
  std::vector<double> positions, rates, accelerations;  ///< [times, freedoms]

  /// Freedoms of all joints together.
  size_t freedoms() const { return times.empty() ? 0 : positions.size() / times.size(); }
};

/// The wrench of every joint while the mechanism goes through a motion that is given, with verdicts
/// and rules as Simulate has them. Velocities and accelerations are those of the motion; nothing is
/// differentiated. What acts is what the simulation names: weight, springs, dampers, motors, hand,
/// external loads, friction, limits. Its drives exert what the motion takes. Its times, start and
/// start rates are not looked at.
///
/// `progress`: called with the number of poses done; false ends it with a std::runtime_error.
///
/// @throws as RequireValid; std::invalid_argument if the history is of another size, its loops are
///         open, or the forces do not give its accelerations: naming the time, the freedom and what
///         is missing there.
LoadStudyResult EvaluateMotionLoads(const Simulation& simulation, const JointHistory& history,
                                    const std::function<bool(size_t done)>& progress = {});

}  // namespace vmech
