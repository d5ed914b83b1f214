#pragma once

#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "vmech/mechanisms/mechanism.h"

namespace vmech {

// What stands in a URDF file, in SI units and radians, before anything is made of it.

/// A link as a URDF file has it.
struct UrdfLink {
  std::string name;                                ///< unique in the file
  int line = 0;                                    ///< from 1
  MassProperties mass_properties;                  ///< in the axes of the link, as written
  bool has_inertial = false, has_inertia = false;  ///< elements of these names are there
};

/// The types of joints of URDF.
enum class UrdfJointType { kRevolute, kContinuous, kPrismatic, kPlanar, kFixed, kFloating };

/// A joint as a URDF file has it.
struct UrdfJoint {
  std::string name, parent, child;             ///< names of the joint and of its links
  int line = 0;                                ///< from 1
  UrdfJointType type = UrdfJointType::kFixed;  ///< as written
  Posed X_PC;                                  ///< child at zero, in the parent
  Vector3d axis = Vector3d::UnitX();           ///< axes of the child, of any length but zero
  bool has_limits = false;                     ///< `lower` and `upper` are given
  double lower = 0, upper = 0;                 ///< [m] or [rad]
  double damping = 0, friction = 0;            ///< [N s/m] or [N m s/rad], [N] or [N m]
  std::string mimics;                          ///< the joint after which it moves; empty: none
};

/// A robot as a URDF file has it.
struct UrdfRobot {
  std::string name;               ///< of the robot
  std::vector<UrdfLink> links;    ///< in the order of the file
  std::vector<UrdfJoint> joints;  ///< in the order of the file
  /// What is not for a mechanism and is left out, "3 <visual>", in the order of the alphabet.
  std::vector<std::string> left_out;
};

/// Reads URDF 1.0 and 1.1. Every number must be finite and every name unique.
/// @throws FileErrors with all that is wrong, each with its line; `file` names the text.
UrdfRobot ParseUrdf(std::string_view text, const std::string& file);

/// Indices of the links from the root on, each parent before its children, depth first in the order
/// of the file. @throws FileErrors if the joints do not make a tree of all links: joints from or to
/// links that there are not, a link with two parents, a cycle, several roots. `file` names it.
std::vector<int> LinksFromRoot(const UrdfRobot& robot, const std::string& file);

/// Index of the joint that carries each link; -1 for a root.
std::vector<int> ParentJoints(const UrdfRobot& robot);

}  // namespace vmech
