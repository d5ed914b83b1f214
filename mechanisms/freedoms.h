#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "vmech/base/pose.h"
#include "vmech/mechanisms/joint_type.h"

namespace vmech {

/// Which motions a joint type leaves free.
struct Freedoms {
  std::array<bool, 6> free;   ///< along x, y, z and about x, y, z
  std::vector<bool> rotates;  ///< per freedom, in the order of the joint's lists
};

/// The freedoms of a joint of this type; the same object at every call.
const Freedoms& FreedomsOfType(JointType type);

/// True if at least one freedom of this joint type is a rotation.
bool Rotates(JointType type);

/// The lengths of LoadFriction that the friction law of a joint type uses.
struct FrictionKeys {
  bool radius, thrust_radius, length, width;  ///< true: the law uses the length of this name
};
/// The lengths that a joint of this type uses.
FrictionKeys FrictionKeysOf(JointType type);

/// A turn about, or a shift along, an axis of the joint's frame.
struct ElementaryFreedom {
  bool rotates;  ///< true: a turn about the axis; false: a shift along it
  int axis;      ///< 0, 1, 2 for x, y, z
};

/// The freedoms of a joint in the order of its lists, from its first anchor to its second: X_FM is
/// the product of their motions. The shift of a screw goes with its turn; a spherical joint, whose
/// coordinates are a quaternion, is here three turns about x, y, z.
std::vector<ElementaryFreedom> ElementaryFreedoms(JointType type);

/// The name of a freedom in files, tables and messages: x, y, z along and rx, ry, rz about the axes
/// of the joint's frame. A screw, whose travel goes with its turn, has rz alone.
std::string NameOfFreedom(JointType type, int freedom);

/// The names of all freedoms in the order of the joint's lists: x, y, rz of a planar joint.
std::vector<std::string> NamesOfFreedoms(JointType type);

/// The index of a freedom by its name; -1 if the type has none of that name.
int FindFreedom(JointType type, std::string_view name);

/// The rotation that permutes the axes cyclically and brings z onto the given axis (0, 1, 2 for x,
/// y, z).
Matrix3d ZOnto(int axis);

}  // namespace vmech
