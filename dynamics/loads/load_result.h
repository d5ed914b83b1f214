#pragma once

#include <array>
#include <string>
#include <vector>

#include "vmech/dynamics/loads/load_arrays.h"
#include "vmech/dynamics/reactions/certainty.h"

namespace vmech {

/// What a load study came to, in SI units. Shapes stand in square brackets.
struct LoadStudyResult {
  PoseSeries poses;                        ///< of the study, in its order
  std::vector<JointCertainty> certainty;   ///< per joint; `singular` only if it is so at every pose
  std::vector<Certainty> drive_certainty;  ///< per drive: determined, or not (kNotDetermined)
  std::vector<size_t> singular_poses;      ///< indices of poses at or very near a dead centre
  int mobility = 0;                        ///< independent motions of the mechanism
  int redundant_equations = 0;             ///< of its loops: statics leaves as many forces open
  std::vector<std::string> cut_joints;     ///< names of joints that close the loops
  std::vector<std::string> idle;           ///< freedoms that move nothing the loads depend on
  double norm_length = 0;      ///< used by minimum_norm, and for stiffness where none is given [m]
  double max_closure = 0;      ///< largest PoseLoads::closure of all poses [-]
  double max_power_error = 0;  ///< largest PoseLoads::power_error of all poses [-]
  std::vector<std::string> warnings;  ///< sentences for the user
  std::vector<std::string> notes;     ///< what the assembly did, as AssembledMechanism::Notes
  /// Per joint and component: not determined by statics, and loaded by this study. What is zero at
  /// every pose whatever the stiffnesses, as forces across the plane of a planar load are, is not.
  std::vector<std::array<bool, 6>> open;
  std::string BriefReport() const;  ///< some lines for a terminal
};

}  // namespace vmech
