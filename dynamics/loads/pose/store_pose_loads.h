#pragma once

#include "vmech/dynamics/loads/load_arrays.h"
#include "vmech/dynamics/loads/pose/load_workspace.h"
#include "vmech/dynamics/loads/pose/study_motion.h"

namespace vmech {

/// Arrays for the loads at all poses of a motion; times and what the drives prescribe are entered.
LoadArrays MakeLoadArrays(const LoadModel& model, const Motion& motion, bool link_motions);

/// Enters what EvaluatePoseLoads computed last, at the poses `pose`, `pose` + 1, ... (as many as T
/// has lanes), into arrays of the model. Links and states are entered if there is room for them.
template <typename T>
void StorePoseLoads(const LoadModel& model, const Motion& motion, size_t pose,
                    const LoadWorkspace<T>& ws, LoadArrays* arrays);

}  // namespace vmech
