#pragma once

#include <vector>

#include "vmech/kinematics/tree/kinematic_tree.h"

namespace vmech {

/// What Reconcile() found.
struct Reconciliation {
  bool closes = false;    ///< the loops close, and go on closing as the mechanism moves
  double correction = 0;  ///< movement of anchors, root mean square [characteristic lengths, rad]
  int joint = -1;         ///< where it is largest
  double misfit = 0;      ///< largest loop error that is left, at the poses of the walk
  Mechanism mechanism;    ///< with anchors moved
  VectorXd q;             ///< its closed pose [nq]
};

/// How far figures may be moved to let loops close.
struct ReconcileOptions {
  /// Loop errors beyond this are not taken for rounding [characteristic lengths, rad], > 0.
  double largest_misfit = 3e-3;
  int poses = 64;  ///< about how many poses the loops are made to close at, > 0
};

/// Makes overconstrained loops close that do not for the rounding of their figures. A planar
/// linkage in space, a Bennett or a Bricard linkage moves only as long as its axes lie in a special
/// way; drawn with four to twelve digits they do not, its redundant equations contradict each other
/// by the rounding, and no pose closes it to more than that. The mechanism meant is the nearest one
/// that moves: the anchors of the loops' joints are moved by twists p (in their own axes, lengths
/// over the characteristic length), as little as possible, until the loops close at poses q_k along
/// all that the mechanism can do,
///
///   minimise |p|^2   subject to   U_k' W e2(q_k, p) = 0,
///
/// U_k the left null space of the dimensionless C there: what no motion can close. The q_k follow
/// by least squares over all rows, C dq = e2 with pivots that are rounding taken as zero. What is a
/// pivot and what is rounding is judged by the misfit that a walk along the motion leaves. Parts of
/// a mechanism that have no velocity and no anchor in common are reconciled one by one.
///
/// q: a pose near to closed. Nothing is made where the misfit is beyond `largest_misfit`, or where
/// the pivots are not those of rounding: `closes` is then false, `mechanism` and `q` are as given.
Reconciliation Reconcile(const KinematicTree& tree, const VectorXd& q,
                         const ReconcileOptions& options = {});

}  // namespace vmech
