#pragma once

#include <array>
#include <vector>

#include "vmech/mechanisms/mechanism.h"

namespace vmech {

/// Which motions a joint type leaves free.
struct Freedoms {
  std::array<bool, 6> free;   ///< along x, y, z and about x, y, z
  std::vector<bool> rotates;  ///< per freedom, in the order of the joint's lists
};

const Freedoms& FreedomsOfType(JointType type);

/// Is any freedom a rotation?
bool Rotates(JointType type);

}  // namespace vmech
