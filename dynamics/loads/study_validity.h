#pragma once

#include "vmech/dynamics/loads/load_study.h"

namespace vmech {

/// Checks that a study says what it needs to, without contradiction; its mechanism is checked by
/// RequireValid of a mechanism.
/// @throws std::invalid_argument naming the field, its value and what it must be.
void RequireValid(const LoadStudy& study);

}  // namespace vmech
