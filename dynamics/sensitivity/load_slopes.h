#pragma once

#include <vector>

#include "vmech/dynamics/sensitivity/study_change.h"

namespace vmech {

/// Derivatives of the loads of a study by one parameter, per unit of it, at every pose; the arrays
/// are those of these names in LoadArrays.
struct LoadSlopes {
  std::vector<double> wrenches;          ///< [poses, joints, fx fy fz mx my mz]
  std::vector<double> drive_forces;      ///< [poses, drives]
  std::vector<double> positions, rates;  ///< [poses, freedoms]
};

/// Can the loads of a study be differentiated? The reason why not, or nothing.
std::string ReasonAgainstSlopes(const LoadModel& model);

/// The loads' derivatives by the parameter of `change`.
/// @throws std::invalid_argument where ReasonAgainstSlopes has one; std::runtime_error where there
///         is no derivative: the parameter opens a loop, friction holds a joint at rest, a pose is
///         a dead centre.
LoadSlopes DifferentiateLoads(const PreparedStudy& prepared, const Motion& motion,
                              const StudyChange& change);

}  // namespace vmech
