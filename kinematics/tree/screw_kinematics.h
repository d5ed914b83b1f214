#pragma once

#include <vector>

#include "vmech/base/screw.h"
#include "vmech/kinematics/tree/jacobian.h"
#include "vmech/kinematics/tree/tree_workspace.h"

namespace vmech {

/// The algorithms of forward_kinematics.h and loops.h for one pose at a time in whole registers and
/// with screws about Wo, for the tick: half the instructions, and what they give agrees to
/// rounding. Bodies far from Wo lose digits, about one for a distance of three times their size.

/// The state of one loop.
struct LoopScrews {
  LoopState<double> state;  ///< R_FM, n_F and e2 alone
  Axes F;                   ///< the cut joint's first anchor, at the second's origin M
  Screw rows[6];            ///< what a unit multiplier of each equation does to the second link
};

/// Memory for one pose of a tree, sized once.
struct ScrewWorkspace {
  explicit ScrewWorkspace(const KinematicTree& tree);

  /// Node i is at i + 1; the ground comes first.
  struct Node {
    Axes X_PF;  ///< of the tree
    Axes X;     ///< X_WB
    Screw V;    ///< twist
    Screw c;    ///< velocity product: what A would be if the parent's A and v' were zero
    Screw A;    ///< rate of V; the ground's is the caller's, who lets it fall upwards for gravity
    Screw p;    ///< velocity product: what F would be if A were zero
    Screw F;    ///< what the parent exerts on this node
  };
  std::vector<Node> nodes;
  std::vector<Screw> S;  ///< twist of each unit velocity [nv]
  std::vector<LoopScrews> loops;
  std::vector<double> sine, cosine;  ///< of KinematicTree::turning, see Sines

  const Node& at(int node) const { return nodes[node + 1]; }
  Node& at(int node) { return nodes[node + 1]; }
};

/// Poses of all nodes, and the joints' twists; writes X and S.
void ForwardKinematics(const KinematicTree& tree, const double* q, ScrewWorkspace* ws) noexcept;
/// V from v [nv]. Needs S.
void ForwardVelocities(const KinematicTree& tree, const double* v, ScrewWorkspace* ws) noexcept;
/// Needs V; writes c, and A for v' = 0.
void VelocityProducts(const KinematicTree& tree, ScrewWorkspace* ws) noexcept;
/// A from v' [nv]. Needs S and c.
void ForwardAccelerations(const KinematicTree& tree, const double* vdot,
                          ScrewWorkspace* ws) noexcept;

/// Geometric Jacobian J of a point Q that moves with a node, V_WQ = J v: its columns [nv] are
/// twists about Q. Needs S.
void PointJacobian(const KinematicTree& tree, const ScrewWorkspace& ws, int node, const Four& p_WQ,
                   std::vector<Screw>* J) noexcept;
/// The same as a matrix [6, nv], [v; w].
void FillMatrix(const std::vector<Screw>& columns, Matrix6Xd* J) noexcept;

/// Loop errors. Needs X; writes `state` and F.
void LoopErrors(const KinematicTree& tree, ScrewWorkspace* ws) noexcept;
/// Writes `rows`, the rows of C as wrenches: C_kv = +-rows[k] . S_v for the velocities around the
/// loop. `row_scale` [tree.rows] as LoopRowScale. Needs LoopErrors.
void LoopWrenches(const KinematicTree& tree, const double* row_scale, ScrewWorkspace* ws) noexcept;
/// s dC/dt v of one loop, in the scale of its rows. Needs LoopWrenches, V and A for v' = 0; writes
/// Loop::rows entries.
void LoopBias(const KinematicTree& tree, const ScrewWorkspace& ws, int loop, double s,
              double* bias) noexcept;

}  // namespace vmech
