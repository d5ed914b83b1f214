#pragma once

#include <string_view>

namespace vmech {

/// The kinds of joints, and the motions of the second anchor against the first that each leaves
/// free.
enum class JointType {
  kRevolute,     ///< about z
  kPrismatic,    ///< along z
  kCylindrical,  ///< along z, about z (independent)
  kScrew,        ///< about z, with `pitch` along z
  kUniversal,    ///< about x of the first anchor, then about y of the second
  kSpherical,    ///< all three rotations
  kPlanar,       ///< along x and y of the first anchor, then about z
  kWeld,         ///< none
};

/// The word used in files, "revolute".
std::string_view NameOf(JointType type);
/// The number of freedoms of a joint, f = 0..3.
int FreedomsOf(JointType type);
/// The number of values in `Joint::start`: one per freedom, but 4 (a unit quaternion w, x, y, z)
/// for a spherical joint.
int CoordinatesOf(JointType type);

}  // namespace vmech
