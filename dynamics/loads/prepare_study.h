#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "vmech/dynamics/loads/load_study.h"
#include "vmech/dynamics/loads/pose/load_model.h"
#include "vmech/kinematics/loops/mobility.h"

namespace vmech {

/// A study made ready: the tree with the driven joints whole, assembled at the file's start values,
/// and its freedoms divided among drives.
struct PreparedStudy {
  LoadModel model;                           ///< what every pose is computed with
  VectorXd q_start;                          ///< closed pose near the start values
  Mobility mobility;                         ///< with drives released
  double closure_tolerance = 0;              ///< as AssembledMechanism::closure_tolerance
  std::vector<std::string> idle;             ///< names of idle freedoms
  std::vector<std::string> warnings, notes;  ///< for the user; `notes` of the assembly
};

/// @throws std::invalid_argument if the study contradicts itself (drive and hand, a joint
///         without that freedom, drives that cannot all move, freedoms that nothing prescribes and
///         that the loads depend on), std::runtime_error if the loops cannot be closed.
PreparedStudy PrepareStudy(const LoadStudy& study);

/// The drives' positions in words, "with 'main' at 180 deg", and what may be done at a dead centre.
std::string DrivesAt(const LoadStudy& study, const std::vector<double>& positions);
/// What a user may do about a pose at a dead centre.
inline constexpr std::string_view kPastDeadCentre =
    "Drive another joint, stop the motion short of it, or leave the pose out by another start or "
    "number of steps";

}  // namespace vmech
