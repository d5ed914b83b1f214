#pragma once

#include <string>
#include <vector>

#include "vmech/mechanisms/cad/mechanism_from_cad.h"

namespace vmech {

/// A study (docs/study-format.md) of an imported mechanism, without its `mechanism` key: the joints
/// turned by motors at constant speed, and bearings at every joint whose shaft is drawn: bore the
/// diameter of the shaft, housing and positions those of the bores around it.
/// What is assumed is added to `guesses`.
/// @throws std::invalid_argument if a driven joint is not there, or if there is none to drive.
std::string StudyText(const CadImport& import, const std::vector<std::string>& drives, double rpm,
                      std::vector<std::string>* guesses);

}  // namespace vmech
