#pragma once

#include "vmech/dynamics/loads/pose/load_workspace.h"

namespace vmech {

/// Power balance of one pose: drives + hand + external loads + springs and friction against d/dt of
/// kinetic energy and height. Reads the drive forces, the node velocities and
/// accelerations; joint wrenches have no part in it, so that it is a check on the whole. Writes
/// power, power_gap, power_size.
template <typename T>
void EvaluatePower(const LoadModel& model, LoadWorkspace<T>* ws);

}  // namespace vmech
