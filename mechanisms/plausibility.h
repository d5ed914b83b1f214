#pragma once

#include <string>
#include <vector>

#include "vmech/mechanisms/mechanism.h"

namespace vmech {

// Figures that are possible, and yet seldom meant: a unit that was forgotten, a decimal point that
// moved. Each doubt is a sentence with the figure and the remedy. They refuse nothing.

/// Of a mechanism: a link's radius of gyration far beyond or far below its size; a link of more
/// than 10 m or of less than 0.1 mm; a gravity that no planet has; no mass at all; a start of more
/// than a turn. A mechanism without mass is no doubt where it is `loaded` from outside.
std::vector<std::string> DoubtsOf(const Mechanism& mechanism, bool loaded = false);

/// Of a density [kg/m^3] that some part is made of: lighter than foam or heavier than any metal.
std::vector<std::string> DoubtsOfDensity(const std::string& part, double density);

}  // namespace vmech
