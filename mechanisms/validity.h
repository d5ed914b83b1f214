#pragma once

#include <cstddef>
#include <string_view>

#include "vmech/mechanisms/mechanism.h"

namespace vmech {

/// Checks that a mechanism can be computed with: names are unique, indices are those of items that
/// exist, figures are finite, axes are square and right-handed, inertias are not negative, and
/// lists have a value per freedom. What a reader gives is valid; what a program puts together may
/// not be.
/// @throws std::invalid_argument naming the item, the field, its value and what it must be.
void RequireValid(const Mechanism& mechanism);

/// `index` must be one of a list of `count`: joints, links, grasps. `field` is what holds the
/// index, as in "drives[0].joint".
/// @throws std::invalid_argument naming field, value and range.
void RequireIndex(std::string_view field, int index, size_t count);

/// Refuses a number that is infinite or NaN.
/// @throws std::invalid_argument naming field and value.
void RequireFinite(std::string_view field, double value);
/// Refuses a number that is infinite, NaN or below zero.
/// @throws std::invalid_argument naming field and value.
void RequireNonNegative(std::string_view field, double value);

}  // namespace vmech
