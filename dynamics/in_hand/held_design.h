#pragma once

#include <span>
#include <string>
#include <vector>

#include "vmech/kinematics/tree/grasp_frame.h"
#include "vmech/kinematics/tree/kinematic_tree.h"

namespace vmech {

/// The numbers of a mechanism in hands, which change while it is held: those of its tree, of
/// springs, friction and limits, and where the hands hold it. All designs of a mechanism have the
/// same topology and so the same sizes.
struct HeldDesign {
  /// The numbers of a node's freedom.
  struct FreedomNumbers {
    Passive passive;              ///< spring and friction
    double lower = 0, upper = 0;  ///< limits [m] or [rad]; infinite where there is none
  };
  VectorXd values;  ///< of the parameters that the design was made for; blended with the rest
  TreeDesign<double> tree;                ///< of nodes and anchors
  std::vector<FreedomNumbers> freedoms;   ///< of every node of the tree
  Vector3d gravity_W = Vector3d::Zero();  ///< [m/s^2]
  std::vector<GraspFrame> grasps;         ///< where hands hold it, a frame for each
};

/// `grasps`: of the mechanism, by index.
HeldDesign HeldDesignOf(const KinematicTree& tree, std::span<const int> grasps = {},
                        const VectorXd& values = {});

/// The mechanism of a tree with the numbers of a design, `grasps` as above.
Mechanism MechanismWith(const HeldDesign& design, const KinematicTree& tree,
                        std::span<const int> grasps = {});

/// The design between two: `share` in [0, 1] is 0 at `from`. Every number goes straight, rotations
/// as near to that as rotations can: masses and inertias stay those of bodies. `between` has the
/// sizes already.
void Blend(const HeldDesign& from, const HeldDesign& to, double share,
           HeldDesign* between) noexcept;

bool HasSameNumbers(const HeldDesign& a, const HeldDesign& b);  ///< all but `values`

/// How far a frame of `to` is from the same of `from` at most [m]; a rotation counts as the way of
/// a point at the characteristic length.
double WayBetween(const KinematicTree& tree, const HeldDesign& from, const HeldDesign& to);

/// Why a mechanism cannot take the other's place while it is held: another topology, or springs and
/// limits at other joints. Empty if it can. Both trees are cut at the same joints.
std::string WhyNotInPlaceOf(const KinematicTree& held, const KinematicTree& other);

}  // namespace vmech
