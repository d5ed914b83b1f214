#pragma once

#include <utility>
#include <vector>

#include "vmech/dynamics/in_hand/virtual_coupling.h"
#include "vmech/dynamics/loads/pose/load_model.h"
#include "vmech/dynamics/loads/pose/study_motion.h"
#include "vmech/dynamics/simulation/equations/constrained_motion.h"
#include "vmech/dynamics/simulation/simulation.h"

namespace vmech {

/// What acts on a mechanism that is simulated, beside what is held: springs, dampers and motors
/// along the freedoms of joints, external wrenches, the coupling of a hand. Nothing allocates after
/// construction, unless the hand's callback does.
class ActingForces {
 public:
  /// Keeps references. `model` has an external load for each of the simulation's, and one more for
  /// the hand's coupling, all of them constant: they become what acts at the time.
  ActingForces(const Simulation& simulation, LoadModel* model);

  /// Angles of cut joints continue from those that they have in `motion`.
  void Remember(const ConstrainedMotion& motion);

  /// The same from another one's.
  void ContinueFrom(const ActingForces& other) { cut_positions_ = other.cut_positions_; }
  /// The same from given coordinates of the cut joints [loops].
  void ContinueFrom(std::vector<Vector3d> cut_positions) {
    cut_positions_ = std::move(cut_positions);
  }

  /// Positions and rates of all joints into ws().loads of `motion`, which has pose and velocities.
  void FindJoints(ConstrainedMotion* motion);
  /// The same of those on which forces, limits or tables depend, and maybe of others.
  void FindJointsThatCount(ConstrainedMotion* motion);
  /// Finds what motors, external loads and the hand do there. Needs FindJointsThatCount.
  void Evaluate(double time, ConstrainedMotion* motion);
  /// Writes ws().passive and ws().applied: of these, of springs and dampers, and of dry friction by
  /// ws().sliding and the wrenches of ws().loads.
  void Apply(ConstrainedMotion* motion) const;
  /// [joints] what Apply has exerted along the joints' freedoms beside their springs and dampers.
  std::vector<Vector3d> BesideSprings(const ConstrainedMotion& motion) const;

  // Of the last Evaluate.
  double MotorForce(size_t motor) const { return motor_forces_[motor]; }  ///< [N] or [N m]
  Wrenchd hand() const;  ///< on the mechanism at Go, world axes
  /// [joints] what motors exert along the joints' freedoms.
  const std::vector<Vector3d>& motors() const { return exerted_; }
  /// Power of motors, external wrenches and the hand; that is lost in dampers and friction [W].
  double SuppliedPower(const ConstrainedMotion& motion) const;
  /// In dampers and friction, positive [W].
  double LostPower(const ConstrainedMotion& motion) const;
  /// Energy of the joints' springs [J].
  double SpringEnergy(const ConstrainedMotion& motion) const;

  /// One pose as a load study knows it, for EvaluatePoseLoads.
  Motion PoseOf(double time, const ConstrainedMotion& motion) const;

 private:
  /// A freedom of a joint that is not cut.
  struct TreeFreedom {
    FreedomId at;
    int q = -1, v = -1;  ///< where it is in q and v
    Passive passive;
  };

  void ListJoints();
  void ActAlongTree(LoadWorkspace<double>* ws) const;
  void ApplyExternal(double time, ConstrainedMotion* motion);
  void ApplyHand(double time, const ConstrainedMotion& motion);
  void RunMotors(double time, const ConstrainedMotion& motion);
  double TableArgument(const ExternalLoad& load, double time,
                       const ConstrainedMotion& motion) const;

  const Simulation& simulation_;
  LoadModel& model_;
  std::vector<int> passive_joints_;  ///< those with springs, dampers or dry friction
  /// Freedoms that count, if all of them are in the tree and none has dry friction, which is what
  /// most mechanisms have: nothing is asked of cut joints then.
  std::vector<TreeFreedom> tree_freedoms_;
  bool all_in_tree_ = true;
  std::vector<VirtualCoupling> coupling_;  ///< none or one
  std::vector<Vector3d> exerted_;          ///< [joints]
  std::vector<double> motor_forces_;
  std::vector<Vector3d> cut_positions_;  ///< [loops] to continue from
  std::vector<Vector3d> here_;           ///< [loops] of the last FindJoints
  Motion none_;                          ///< that of constant loads
};

}  // namespace vmech
