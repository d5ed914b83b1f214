#pragma once

#include <string>

#include "vmech/mechanisms/dh/denavit_hartenberg.h"

namespace vmech {

/// The table for a terminal, in millimetres and degrees. Every figure has the 15 digits that it
/// takes to compute poses from what is printed; what is less than 1e-12 of either unit is zero.
std::string DhText(const Mechanism& mechanism, const DhTable& table);

}  // namespace vmech
