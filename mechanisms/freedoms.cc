#include "vmech/mechanisms/freedoms.h"

#include <algorithm>

namespace vmech {

const Freedoms& FreedomsOfType(JointType type) {
  static const Freedoms kTable[] = {
      {{0, 0, 0, 0, 0, 1}, {true}},                // revolute
      {{0, 0, 1, 0, 0, 0}, {false}},               // prismatic
      {{0, 0, 1, 0, 0, 1}, {false, true}},         // cylindrical
      {{0, 0, 1, 0, 0, 1}, {true}},                // screw
      {{0, 0, 0, 1, 1, 0}, {true, true}},          // universal
      {{0, 0, 0, 1, 1, 1}, {true, true, true}},    // spherical
      {{1, 1, 0, 0, 0, 1}, {false, false, true}},  // planar
      {{0, 0, 0, 0, 0, 0}, {}},                    // weld
  };
  return kTable[static_cast<int>(type)];
}

bool Rotates(JointType type) {
  const std::vector<bool>& rotates = FreedomsOfType(type).rotates;
  return std::find(rotates.begin(), rotates.end(), true) != rotates.end();
}

}  // namespace vmech
