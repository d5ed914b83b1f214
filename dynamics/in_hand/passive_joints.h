#pragma once

#include <vector>

#include "vmech/dynamics/in_hand/held_design.h"
#include "vmech/kinematics/tree/kinematic_tree.h"

namespace vmech {

/// Springs, friction and limits of the tree's joints in a hand. Steps of T take them at their end,
/// so that they only take energy.
class PassiveJoints {
 public:
  /// @throws std::invalid_argument naming the joint for friction in proportion to a joint's load,
  /// and for springs or friction at a cut joint, which are beyond these paths.
  explicit PassiveJoints(const KinematicTree& tree);

  /// Takes other numbers of the same freedoms.
  void Take(const HeldDesign& design) noexcept;

  /// Adds them to A v+ = right: a spring and a damper as they are, dry friction as the damper that
  /// it is at the velocities v, of all freedoms of a contact together.
  void AddTo(const VectorXd& q, const VectorXd& v, double step, MatrixXd* A,
             VectorXd* right) const noexcept;
  /// tau += k (q - rest) + c v [nv]: what it takes to move against them, c as above.
  void AddForces(const VectorXd& q, const VectorXd& v, VectorXd* tau) const noexcept;
  /// Energy of the springs [J].
  double Energy(const VectorXd& q) const noexcept;

  /// Adds the limits that hold.
  void AddLimits(const VectorXd& q, double step, MatrixXd* A, VectorXd* right) const noexcept;
  /// Limits that the step at next velocities would pass begin to hold, limits that would pull let
  /// go. True if any did.
  bool ChangeLimits(const VectorXd& q, const VectorXd& next_v, double step) noexcept;
  bool at_limit() const noexcept { return at_limit_; }  ///< some freedom stands at a limit

 private:
  /// A coordinate of its own with a spring, friction or limits.
  struct Freedom {
    int node, q, v;
    Passive passive;
    double lower, upper;
    int contact;   // the same for all freedoms that slide together
    int held = 0;  // -1 at the lower limit, 1 at the upper
  };

  /// visit(freedom, c) with c what all its friction is as a damper at v.
  template <typename Visit>
  void ForEachDamper(const VectorXd& v, const Visit& visit) const noexcept;

  std::vector<Freedom> freedoms_;
  bool at_limit_ = false;
};

/// Dry friction builds up in proportion to the speed until here [m/s] or [rad/s].
inline constexpr double kSlowSliding = 1e-2;

/// How to cut loops for these paths, which know springs, friction and limits of joints in the tree
/// only: joints with springs or friction are kept whole, those with limits where that can be.
SpanningTreeOptions KeepPassiveJoints(const Mechanism& mechanism);

/// Refuses what PassiveJoints cannot render.
/// @throws std::invalid_argument as the constructor of PassiveJoints.
void RefuseUnrenderedFriction(const KinematicTree& tree);

}  // namespace vmech
