#pragma once

#include "vmech/base/pose.h"

namespace vmech {

/// What a joint does and carries, in the axes of the anchor on its first link.
template <typename T>
struct JointLoad {
  Wrench<T> W_F;        ///< what the first link exerts on the second, about the second anchor
  Vector3<T> position;  ///< coordinates of its freedoms
  Vector3<T> rate;
  Vector3<T> acceleration;  ///< of the coordinates, the slopes of `rate`
};

}  // namespace vmech
