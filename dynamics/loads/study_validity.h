#pragma once

#include <string>
#include <vector>

#include "vmech/dynamics/loads/load_study.h"

namespace vmech {

/// Checks that a study says what it needs to, without contradiction; its mechanism is checked by
/// RequireValid of a mechanism.
/// @throws std::invalid_argument naming the field, its value and what it must be.
void RequireValid(const LoadStudy& study);

/// Nothing is known of a motion beyond its table, from `begins` to `ends` [s]. `times` increase and
/// are not empty.
/// @throws std::invalid_argument naming the field and both if they go beyond.
void RequireCovered(const std::string& field, double begins, double ends,
                    const std::vector<double>& times);

}  // namespace vmech
