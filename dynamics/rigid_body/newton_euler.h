#pragma once

#include <type_traits>
#include <vector>

#include "vmech/kinematics/tree/forward_kinematics.h"

namespace vmech {

// Dynamics of a tree whose cut joints are left open, in screws about the reference point. What a
// pass finds stays for the next: inertias hold as long as the pose.

/// Inertia of every node, node i at i + 1.
template <typename T>
struct TreeInertias {
  /// Sizes everything, and takes the tree's numbers.
  explicit TreeInertias(const KinematicTree& tree);
  /// The same with other numbers than the tree's.
  TreeInertias(const KinematicTree& tree, const TreeDesign<T>& design);

  /// Takes other numbers of the same tree.
  void Take(const TreeDesign<T>& design) noexcept;

  /// As in TreeNode, axes of the node.
  struct Body {
    T mass = T(0);               ///< [kg]
    Triple<T> p_BoBcm{};         ///< centre of mass from the node's origin [m]
    Triple<T> Ix{}, Iy{}, Iz{};  ///< columns of I_Bcm
  };
  std::vector<Body> in_node;             ///< of the tree
  std::vector<ScrewInertiaT<T>> bodies;  ///< about the reference point

  // CompositeMassMatrix's own: each node with all that hangs on it; what other nodes than the next
  // have given to a node, if any have; and the places of M that are not zero, velocity by velocity
  // with those on the way to the ground.
  std::vector<ScrewInertiaT<T>> composites, received;  ///< about the reference point
  std::vector<char> has_received;                      ///< per node: `received` holds something
  /// A pair of velocity indices whose entry in the mass matrix is not zero.
  struct Entry {
    int node, v, u;    ///< the node, indices in the velocities
    int above, below;  ///< (u, v) and (v, u) in M
  };
  std::vector<Entry> entries;  ///< of all nodes
};

/// Gravity is applied by giving the ground the acceleration -g, once, so that no body needs a
/// weight of its own.
template <typename T>
void SetGravity(const std::type_identity_t<Vector3<T>>& gravity_W, TreeWorkspace<T>* ws) noexcept;

/// Inertias of the bodies. Needs X.
template <typename T>
void BodyInertias(const KinematicTree& tree, const TreeWorkspace<T>& ws,
                  TreeInertias<T>* inertias) noexcept;

/// Mass matrix M [nv, nv] of the tree by composite rigid bodies [Walker & Orin 1982]:
///
///   M_ij = S_j' I_i^c S_i,   j on the way from i to the ground.
///
/// Needs S and BodyInertias, and an M that was zero in the beginning: writes what joints of one
/// branch have with each other. O(n depth).
void CompositeMassMatrix(const KinematicTree& tree, const TreeWorkspace<double>& ws,
                         TreeInertias<double>* inertias, MatrixXd* M) noexcept;

/// Needs BodyInertias and V; writes p.
template <typename T>
void GyroscopicWrenches(const KinematicTree& tree, const TreeInertias<T>& inertias,
                        TreeWorkspace<T>* ws) noexcept;
/// Inverse dynamics by recursive Newton-Euler: F, what each parent must exert on its node for the
/// bodies to move as they do against `applied`, the wrenches from outside on each node (null:
/// none),
///
///   F_i = I_i A_i + p_i - applied_i + sum over children F_c,
///
/// and the generalised forces S . F [nv] that drives, springs, friction and the loops' multipliers
/// must supply, unless null (paper eq. 9: tau = M q'' + h). Needs A, p and BodyInertias.
template <typename T>
void NewtonEuler(const KinematicTree& tree, const TreeInertias<T>& inertias,
                 const ScrewT<T>* applied, TreeWorkspace<T>* ws, T* tau) noexcept;
/// The generalised forces S . F [nv] of the wrenches F that ws holds.
template <typename T>
void GeneralisedForces(const KinematicTree& tree, const TreeWorkspace<T>& ws, T* tau) noexcept;
/// The joints' momenta M v [nv] at velocities v [nv]: the forces that bring them there from rest in
/// a second. Needs S; writes V and F. Quicker than to find inertias for this alone.
template <typename T>
void Momenta(const KinematicTree& tree, const TreeInertias<T>& inertias, const T* v,
             TreeWorkspace<T>* ws, T* momenta) noexcept;

/// Kinetic energy at the twists V in ws [J]. Needs BodyInertias.
double KineticEnergy(const KinematicTree& tree, const TreeInertias<double>& inertias,
                     const TreeWorkspace<double>& ws) noexcept;
/// - sum m g . p_cm [J], zero where every centre of gravity is at the height of the reference
/// point. Needs BodyInertias.
double WeightEnergy(const Vector3d& gravity_W, const TreeInertias<double>& inertias) noexcept;

/// M(q) [nv, nv].
MatrixXd MassMatrix(const KinematicTree& tree, const VectorXd& q);
/// h(q, v) [nv]: centrifugal, Coriolis and gravity forces.
VectorXd BiasForces(const KinematicTree& tree, const VectorXd& q, const VectorXd& v);

}  // namespace vmech
