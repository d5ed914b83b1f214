#pragma once

#include "vmech/kinematics/tree/tree_workspace.h"

namespace vmech {

/// Inverse dynamics of the tree by recursive Newton-Euler, O(n): what each parent must exert on its
/// node for the links to move as they do,
///
///   F_i = (m (a_cm - g), I alpha + w x I w) - applied_i + sum over children F_c,
///
/// about Bo, world axes. Needs w, alpha, a and X_WB; writes NodeState::F_Bo. `applied` [nodes] are
/// the wrenches from outside on each node about Bo, world axes.
template <typename T>
void RecursiveNewtonEuler(const KinematicTree& tree, const Vector3d& gravity_W,
                          const Wrench<T>* applied, TreeWorkspace<T>* ws);

/// The share of F_Bo along each freedom: the generalised forces tau [nv] that the joints' drives,
/// springs and friction and the loops' multipliers must supply (paper eq. 9: tau = M q'' + h).
template <typename T>
void GeneralisedForces(const KinematicTree& tree, const TreeWorkspace<T>& ws, T* tau);

/// M(q) [nv, nv], from the kinetic energy: sum over links of J_v' m J_v + J_w' I J_w.
MatrixXd MassMatrix(const KinematicTree& tree, const VectorXd& q);
/// h(q, v) [nv]: centrifugal, Coriolis and gravity forces.
VectorXd BiasForces(const KinematicTree& tree, const VectorXd& q, const VectorXd& v);

}  // namespace vmech
