#pragma once

#include <vector>

#include "vmech/dynamics/loads/load_result.h"
#include "vmech/dynamics/loads/load_study.h"

namespace vmech {

/// Does the only motor of a study turn on and on, or move on and on, without standing or turning
/// back?
bool RunsOneWay(const LoadStudy& study, const LoadStudyResult& result);

/// A dead centre: an angle of the motor at which a joint on the ground turns back, such as a slider
/// at the end of its stroke or a rocker at the end of its swing.
struct DeadCentre {
  double angle = 0;  ///< of the motor [rad], from 0 to less than 2 pi
  int joint = -1;    ///< which turns back
};

/// The dead centres of a study in which one motor turns on and on, in the order of their angles, to
/// the square of a step between poses; none of other studies.
std::vector<DeadCentre> FindDeadCentres(const LoadStudy& study, const LoadStudyResult& result);

}  // namespace vmech
