#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "vmech/mechanisms/mechanism.h"

namespace vmech {

/// What the name of a coordinate system in a CAD file means. The prefix is that of vmech or of
/// onshape-to-robot, in upper or lower case; what follows is the name of the joint or grasp:
///
///   anchor_NAME, dof_NAME  an anchor of the joint NAME; two parts that carry one are joined
///   closing_NAME           the same; the joint is where a loop is best cut
///   fix_NAME               the same; the joint is a weld
///   frame_NAME             an anchor without a joint
///   grasp_NAME             a grasp
///
/// Behind it may stand `__TYPE` (revolute, prismatic, cylindrical, universal, spherical or ball,
/// planar, weld or fixed; of a grasp: rigid or point) and `_inv`, which turns the frame by half a
/// turn about its x axis, so that z points the other way.
struct FrameName {
  /// By the prefix.
  enum class Role { kNone, kJoint, kAnchor, kGrasp };
  Role role = Role::kNone;              ///< kNone: the name has no such prefix
  std::string name;                     ///< of the joint or the grasp
  std::optional<JointType> type;        ///< kJoint, kAnchor: where it is given
  GraspKind grasp = GraspKind::kRigid;  ///< kGrasp
  bool inverted = false;                ///< the frame is to be turned
  bool prefer_cut = false;              ///< the joint is to be cut
  std::string error;  ///< what is wrong with it ("'hinge' is no type of joint ..."), or empty
};

/// What the name of a coordinate system says.
FrameName ParseFrameName(std::string_view name);

/// The type of joint that a word names. None if there is no such type, or if it needs more than a
/// frame can say (screw).
std::optional<JointType> JointTypeFromWord(std::string_view word);

}  // namespace vmech
