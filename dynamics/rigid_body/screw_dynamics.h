#pragma once

#include <vector>

#include "vmech/kinematics/tree/screw_kinematics.h"

namespace vmech {

/// The algorithms of newton_euler.h for one pose in screws about Wo, for the tick; joints left
/// open. What a pass finds stays for the next: inertias hold as long as the pose.

/// Inertia of every node, node i at i + 1.
struct ScrewInertias {
  explicit ScrewInertias(const KinematicTree& tree);

  /// As in TreeNode, axes of the node.
  struct Body {
    double mass = 0;
    Four p_BoBcm{};
    Four Ix{}, Iy{}, Iz{};  ///< columns of I_Bcm
  };
  std::vector<Body> in_node;         ///< of the tree
  std::vector<ScrewInertia> bodies;  ///< about Wo

  // CompositeMassMatrix's own: each node with all that it carries; what other nodes than the next
  // have handed to a node, if any have; and the places of M that are not zero, velocity by velocity
  // with those on the way to the ground.
  std::vector<ScrewInertia> composites, carried;
  std::vector<char> carries;
  struct Entry {
    int node, v, u;
    int above, below;  ///< (u, v) and (v, u) in M
  };
  std::vector<Entry> entries;
};

/// Weight is a ground that falls upwards: the ground's A, once.
void SetGravity(const Vector3d& gravity_W, ScrewWorkspace* ws) noexcept;

/// Inertias of the bodies. Needs X.
void BodyInertias(const KinematicTree& tree, const ScrewWorkspace& ws,
                  ScrewInertias* inertias) noexcept;

/// Mass matrix M [nv, nv] of the tree by composite rigid bodies [Walker & Orin 1982]:
///
///   M_ij = S_j' I_i^c S_i,   j on the way from i to the ground.
///
/// Needs S and BodyInertias, and an M that was zero in the beginning: writes what joints of one
/// branch have with each other. O(n depth).
void CompositeMassMatrix(const KinematicTree& tree, const ScrewWorkspace& ws,
                         ScrewInertias* inertias, MatrixXd* M) noexcept;

/// Needs BodyInertias and V; writes p.
void GyroscopicWrenches(const KinematicTree& tree, const ScrewInertias& inertias,
                        ScrewWorkspace* ws) noexcept;
/// F that moves the nodes, and the generalised forces S . F [nv], unless null. Needs A, p and
/// BodyInertias.
void NewtonEuler(const KinematicTree& tree, const ScrewInertias& inertias, ScrewWorkspace* ws,
                 double* tau) noexcept;
/// The joints' momenta M v [nv] at velocities v [nv]: the forces that bring them there from rest in
/// a second. Needs S; writes V and F. Quicker than to find inertias for this alone.
void Momenta(const KinematicTree& tree, const ScrewInertias& inertias, const double* v,
             ScrewWorkspace* ws, double* momenta) noexcept;

/// Kinetic energy at V [J].
double KineticEnergy(const KinematicTree& tree, const ScrewInertias& inertias,
                     const ScrewWorkspace& ws) noexcept;
/// - sum m g . p_cm [J], zero where every centre of gravity is at the height of Wo. Needs
/// BodyInertias.
double WeightEnergy(const KinematicTree& tree, const ScrewInertias& inertias) noexcept;

}  // namespace vmech
