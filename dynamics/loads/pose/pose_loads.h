#pragma once

#include "vmech/dynamics/loads/pose/load_model.h"
#include "vmech/dynamics/loads/pose/load_workspace.h"
#include "vmech/dynamics/loads/pose/study_motion.h"

namespace vmech {

/// Can four poses be evaluated at once? Not where the hand, idle freedoms or friction under
/// load ask for dense systems or iterations of each pose's own.
bool RunsInLanes(const LoadModel& model);

/// Velocities, accelerations, drive forces and the wrench of every joint at the closed poses
/// `pose`, `pose` + 1, ... (as many as T has lanes), from scratch: the same input gives the same
/// bits. Returns false if one of them is a dead centre, where the drive does not determine the
/// motion, or if one of four is a pose at rest, whose friction is found pose by pose; what ws
/// holds is then not to be used.
template <typename T>
[[nodiscard]] bool EvaluatePoseLoads(const LoadModel& model, const Motion& motion, size_t pose,
                                     LoadWorkspace<T>* ws);

/// What acts on each node from outside: external loads, and springs and friction of cut joints.
/// Writes ws->applied.
template <typename T>
void GatherApplied(const LoadModel& model, LoadWorkspace<T>* ws);

/// One pass from the friction under the joint wrenches of ws->loads to new joint wrenches there, at
/// the velocities and accelerations of ws->tree. Needs ws->reactions factored.
template <typename T>
void EquilibriumPass(const LoadModel& model, LoadWorkspace<T>* ws);

}  // namespace vmech
