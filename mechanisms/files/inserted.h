#pragma once

#include <string>

#include "vmech/base/pose.h"
#include "vmech/mechanisms/mechanism.h"

namespace vmech {

/// Puts a mechanism into another. Its ground becomes a part of the link `on`, at the pose X_LU of
/// that link: the ground's mass, anchors and grasps go there. Everything else is added behind what
/// there is; all names get a prefix, "left.foot" for "foot". Gravity and tolerance are not used.
/// Returns a name that would be there twice, or is too long, in words; then nothing is added.
std::string Insert(const Mechanism& part, const std::string& prefix, int on, const Posed& X_LU,
                   Mechanism* whole);

}  // namespace vmech
