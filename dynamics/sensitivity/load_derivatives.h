#pragma once

#include <string>
#include <vector>

#include "vmech/dynamics/sensitivity/load_rows.h"
#include "vmech/dynamics/sensitivity/study_change.h"

namespace vmech {

/// Why the loads of a study cannot be differentiated; empty where they can.
std::string ReasonAgainstDerivatives(const LoadModel& model);

/// The loads at all poses.
/// @throws std::runtime_error at a pose that has no derivative: friction holds a joint at rest or
///         locks the mechanism, or it is at a dead centre.
LoadRows<double> EvaluateLoads(const PreparedStudy& prepared, const Motion& motion);

/// The loads with their derivatives by the parameter of `change`, per unit of it, at some `poses`
/// of the motion. One parameter at a time; GradientOfLoads takes all together.
/// @throws std::invalid_argument where ReasonAgainstDerivatives has one; std::runtime_error as
///         EvaluateLoads, and where the parameter opens a loop.
LoadRows<Dual> DifferentiateLoads(const PreparedStudy& prepared, const Motion& motion,
                                  const StudyChange& change, std::vector<size_t> poses);
/// The same at all poses.
LoadRows<Dual> DifferentiateLoads(const PreparedStudy& prepared, const Motion& motion,
                                  const StudyChange& change);

}  // namespace vmech
