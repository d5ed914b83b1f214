#pragma once

#include "vmech/dynamics/loads/load_study.h"

namespace vmech {

/// Does the study say what it needs to, without contradiction? Its mechanism is looked at by
/// RequireValid of a mechanism.
/// @throws std::invalid_argument naming the field, its value and what it must be.
void RequireValid(const LoadStudy& study);

}  // namespace vmech
