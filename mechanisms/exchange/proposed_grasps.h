#pragma once

#include <string>
#include <vector>

#include "vmech/mechanisms/mechanism.h"

namespace vmech {

/// Links by which a hand may hold a mechanism that names no grasp: those at the end of a chain,
/// held by one joint, that do not stand still with the ground. Where frames without mass are welded
/// to the ends of arms these are the tools. Indices, in the order of the links.
std::vector<int> LeafLinks(const Mechanism& mechanism);

/// Adds a rigid grasp at the drawing frame of a link, called as the link is, or with a number if
/// there is a grasp of this name.
void AddGraspAt(int link, Mechanism* mechanism);

}  // namespace vmech
