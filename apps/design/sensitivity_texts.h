#pragma once

#include <string>

#include "vmech/studies/sensitivities.h"

namespace vmech {

/// For a reader at the terminal: of every figure its value and the parameters that matter most to
/// it, with bars; then what has no derivative, and why.
std::string PrintedSensitivities(const StudyFile& file, const Sensitivities& result);

/// sensitivities.csv: figure, unit, value, parameter, its unit and value, slope [figure's unit by
/// parameter's], elasticity [percent by percent]; empty where there is none.
std::string SensitivityTable(const Sensitivities& result);

}  // namespace vmech
