#pragma once

#include "vmech/base/pose.h"
#include "vmech/mechanisms/mechanism.h"

namespace vmech {

/// A point grasp transmits no moments (paper section 4): of stiffnesses, dampings or masses in the
/// six directions of a grasp frame [linear; angular], those that count in a grasp of this kind.
inline Vector6d RowsThatCount(Vector6d rows, GraspKind kind) noexcept {
  if (kind == GraspKind::kPoint) rows.tail<3>().setZero();
  return rows;
}

}  // namespace vmech
