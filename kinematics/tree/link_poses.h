#pragma once

#include <vector>

#include "vmech/kinematics/tree/kinematic_tree.h"

namespace vmech {

/// The poses X_WL of all links at coordinates q [nq].
std::vector<Posed> LinkPoses(const KinematicTree& tree, const VectorXd& q);

}  // namespace vmech
