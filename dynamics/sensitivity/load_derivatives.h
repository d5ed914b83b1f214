#pragma once

#include <string>
#include <vector>

#include "vmech/dynamics/sensitivity/study_change.h"

namespace vmech {

/// The loads of a study at every pose with their derivatives by one parameter, per unit of it; the
/// arrays are those of these names in LoadArrays.
struct LoadDerivatives {
  std::vector<Dual> times;          ///< [poses]
  std::vector<Dual> wrenches;       ///< [poses, joints, fx fy fz mx my mz]
  std::vector<Dual> drive_forces;   ///< [poses, drives]
  std::vector<Dual> rates;          ///< [poses, freedoms]
  std::vector<Dual> ground_forces;  ///< [poses, 3] of the ground on the mechanism, world axes [N]
  std::vector<Dual> grasps;         ///< [poses, grasps, 3] their origins in the world [m]
  /// [poses, joints, 6] origin [m] and z axis of each joint's first anchor, in the world.
  std::vector<Dual> axes;
  std::vector<int> first_freedom;  ///< [joints + 1]

  std::vector<size_t> pose_numbers;  ///< StudyChange::pose_numbers

  size_t poses() const { return times.size(); }  ///< that were differentiated
  /// The number that a pose has in the whole motion.
  size_t pose_number(size_t pose) const { return pose_numbers.empty() ? pose : pose_numbers[pose]; }
  size_t joints() const { return first_freedom.size() - 1; }  ///< of the mechanism
};

/// Why the loads of a study cannot be differentiated; empty where they can.
std::string ReasonAgainstDerivatives(const LoadModel& model);

/// The loads' derivatives by the parameter of `change`.
/// @throws std::invalid_argument where ReasonAgainstDerivatives has one; std::runtime_error where
///         there is no derivative: the parameter opens a loop, friction holds a joint at rest, a
///         pose is a dead centre.
LoadDerivatives DifferentiateLoads(const PreparedStudy& prepared, const Motion& motion,
                                   const StudyChange& change);

}  // namespace vmech
