#pragma once

#include <vector>

#include "vmech/dynamics/loads/pose/load_workspace.h"
#include "vmech/dynamics/sensitivity/load_rows.h"

namespace vmech {

/// The row of the pose, or of the poses side by side, that `ws` has evaluated. `p_LG` are the
/// origins of the grasps in their links.
template <typename T>
void FillRow(const LoadModel& model, const std::vector<Vector3<T>>& p_LG,
             const LoadWorkspace<T>& ws, const LoadLayout& layout, T* row);

/// @throws std::runtime_error saying why a pose of the motion, `number` of the study, has no
/// derivative: a dead centre, or dry friction at rest.
[[noreturn]] void RefusePose(const LoadModel& model, const Motion& motion, size_t pose,
                             size_t number);

}  // namespace vmech
