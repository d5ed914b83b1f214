#pragma once

#include <string>
#include <vector>

#include "vmech/dynamics/simulation/modes.h"
#include "vmech/dynamics/simulation/simulation.h"

namespace vmech {

/// A file to be written: its name and its text.
struct NamedText {
  std::string name, text;
};

/// equilibrium.yaml, the mechanism at its equilibrium, and mode-1.yaml, mode-2.yaml .. with their
/// tables: studies in which drives move the mechanism through the shape of a mode, a tenth of a
/// radian or of the characteristic length far, a period of the mode long (2 s where it does not
/// swing). No studies where a free motion is that of a spherical joint, which no drive can move.
std::vector<NamedText> ModeStudies(const Modes& modes, const Simulation& at_equilibrium);

}  // namespace vmech
