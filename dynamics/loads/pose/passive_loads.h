#pragma once

#include "vmech/dynamics/loads/pose/load_workspace.h"

namespace vmech {

/// Springs, the friction of what slides, and ws->exerted, under the joint wrenches of ws->loads.
/// Needs ws->sliding; writes ws->along, ws->passive and ws->cut_passive.
template <typename T>
void PassiveForces(const LoadModel& model, LoadWorkspace<T>* ws);

/// Takes ws->along, the forces along the joints' freedoms, to the tree and to the cut joints.
template <typename T>
void SpreadPassive(const LoadModel& model, LoadWorkspace<T>* ws);

/// Where friction locks the mechanism: at a thread that no torque can raise; where the loads have
/// not settled, at the joint whose friction takes the most power. -1 if nothing locks.
int LockingJoint(const LoadModel& model, const LoadWorkspace<double>& ws, bool settled);

}  // namespace vmech
