#pragma once

#include <string>
#include <vector>

#include "vmech/dynamics/simulation/modes.h"
#include "vmech/mechanisms/mechanism.h"

namespace vmech {

/// The equilibrium, its stability and the modes about it, for people. `mechanism`: the one that was
/// asked about, at its equilibrium.
std::string ModesText(const Modes& modes, const Mechanism& mechanism);

/// The same for programs: mode, frequency, damping_ratio, real, imaginary; then for every freedom
/// of every joint <freedom>.real and <freedom>.imaginary of its shape, SI units and radians, of
/// which the largest, lengths over the characteristic length, is 1.
std::string ModesTable(const Modes& modes);

/// What users should know beside: freedoms that rest outside their limits, friction left out, what
/// has no inertia.
std::vector<std::string> ModesWarnings(const Modes& modes, const Mechanism& mechanism);

}  // namespace vmech
