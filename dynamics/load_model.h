#pragma once

#include <string>
#include <vector>

#include "vmech/dynamics/pose_loads.h"
#include "vmech/kinematics/mobility.h"

namespace vmech {

/// A study made ready: the tree with the driven joints whole, assembled at the file's start values,
/// and its freedoms divided among drives.
struct PreparedStudy {
  LoadModel model;
  VectorXd q_start;  ///< closed pose near the start values
  Mobility mobility;
  std::vector<std::string> idle;  ///< names of idle freedoms
  std::vector<std::string> warnings;
};

/// @throws std::invalid_argument if the study contradicts itself (drive and hand, a joint
///         without that freedom, drives that cannot all move, freedoms that nothing prescribes and
///         that the loads depend on), std::runtime_error if the loops cannot be closed.
PreparedStudy PrepareStudy(const LoadStudy& study);

/// Follows the motion from pose to pose on one assembly branch. Poses come from the loop equations;
/// between them the drive moves in smaller steps where a full one would be too long to be sure of
/// the branch.
/// @throws std::runtime_error naming pose and time where the motion cannot be followed.
Motion TrackMotion(const LoadStudy& study, const PreparedStudy& prepared, double closure_tolerance);

}  // namespace vmech
