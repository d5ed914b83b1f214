#pragma once

#include <vector>

#include "vmech/kinematics/tree_workspace.h"

namespace vmech {

/// The inertia of a rigid body or of several as one, about the origin of W, axes of W.
struct CompositeInertia {
  double mass = 0;
  Vector3d moment = Vector3d::Zero();  ///< mass times centre of gravity [kg m]
  Matrix3d I_Wo = Matrix3d::Zero();    ///< [kg m^2]
};

/// What CompositeMassMatrix works with, sized once.
struct MassMatrixMemory {
  explicit MassMatrixMemory(const KinematicTree& tree)
      : bodies(tree.nodes.size()), twists(tree.nv, Vector6d::Zero()) {}

  std::vector<CompositeInertia> bodies;
  std::vector<Vector6d> twists;  ///< of the unit velocities, about the origin of W
};

/// Mass matrix M [nv, nv] of the tree, cut joints left open, by composite rigid bodies [Walker &
/// Orin 1982]: everything that joint i carries moves as one body,
///
///   M_ij = S_j' I_i^c S_i,   j on the way from i to the ground.
///
/// Needs X_WB. O(n depth), no allocation.
void CompositeMassMatrix(const KinematicTree& tree, const TreeWorkspace<double>& ws,
                         MassMatrixMemory* memory, MatrixXd* M);

}  // namespace vmech
