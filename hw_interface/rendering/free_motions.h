#pragma once

#include "vmech/kinematics/tree/tree_workspace.h"

namespace vmech {

/// The motions that the loops of a closed pose leave free, C N = 0 [nv, mobility], orthonormal.
/// Needs ForwardKinematics in ws; writes the loops' errors and Jacobian.
MatrixXd FreeMotions(const KinematicTree& tree, TreeWorkspace<double>* ws);

}  // namespace vmech
