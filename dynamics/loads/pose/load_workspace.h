#pragma once

#include <vector>

#include "vmech/dynamics/loads/pose/friction_iteration.h"
#include "vmech/dynamics/loads/pose/joint_load.h"
#include "vmech/dynamics/loads/pose/load_model.h"
#include "vmech/dynamics/loads/pose/study_motion.h"
#include "vmech/dynamics/rigid_body/newton_euler.h"
#include "vmech/kinematics/loops/closure.h"

namespace vmech {

/// A contact at rest that would slide if the drives that stand still crept.
struct RestingContact {
  int joint = -1;            ///< of the mechanism
  Eigen::Matrix3Xd creep;    ///< [3, standing drives] rates of the joint; zero but in this contact
  Eigen::Matrix3Xd limited;  ///< the same, each rate times the limit of its friction
  double weight = 0;         ///< w_c of resting_friction.h
};

/// Memory for one thread, for one model that must outlive it. T is double for one pose at a time,
/// Lanes4 for four in a row, or Dual and Taped4 for these and their derivatives.
template <typename T>
struct LoadWorkspace {
  explicit LoadWorkspace(const LoadModel& model);  ///< sizes everything
  /// With other numbers than the model's: a Dual that has slopes in some takes the derivative of
  /// every load by them along.
  LoadWorkspace(const LoadModel& model, const Design<T>& design);

  std::vector<typename Design<T>::JointNumbers> numbers;  ///< per joint
  Vector3<T> gravity_W;                                   ///< [m/s^2]
  /// Of duals: how what the study prescribes goes with the parameter; null if it does not.
  const PrescribedSlopes* slopes = nullptr;
  /// Of numbers on a tape, which need it: what the study prescribes at the poses at hand.
  const PrescribedOnTape<T>* on_tape = nullptr;
  TreeWorkspace<T> tree;               ///< pose and Jacobians of links
  DependentSolver<T> dependents;       ///< velocities that follow from others
  ReactionSolver<T> reactions;         ///< what joints transmit
  std::vector<JointState<T>> joints;   ///< per joint: frames and rates
  TreeInertias<T> inertias;            ///< mass, centre and moments of the links
  std::vector<ScrewT<T>> applied;      ///< per node, from outside
  std::vector<Wrench<T>> cut_passive;  ///< per loop: springs and friction of the cut joint, in F
  std::vector<Vector3<T>> sliding;     ///< per joint: its rates, zero where it rests
  std::vector<Vector3<T>> along;       ///< per joint: springs and friction along its freedoms
  std::vector<ScrewT<T>> external;     ///< the external loads
  /// Per joint: what motors, stops and friction that was found before exert along its freedoms,
  /// beside springs and dampers. Null: nothing.
  const Vector3<T>* exerted = nullptr;
  VectorX<T> q, v, vdot;  ///< [nq], [nv], [nv]
  VectorX<T> tau;         ///< needed along each freedom
  VectorX<T> passive;     ///< supplied by springs and friction
  VectorX<T> open;        ///< what is left for drives and multipliers
  VectorX<T> mu;          ///< multipliers of the cut joints
  /// [nv, independent]: free motions, where the hand or idle freedoms need them
  MatrixX<T> motions;
  MatrixX<T> idle_motions;  ///< [nv, idle]: those of them
  MatrixXd creep;           ///< [nv, standing drives]: the motion as each of them begins to move
  std::vector<Vector3d> creep_rates;    ///< [standing drives * joints]
  std::vector<RestingContact> resting;  ///< those of the pose
  VectorXd holding;                     ///< [standing drives] y of resting_friction.h
  int holding_passes = 0;               ///< passes that `holding` took
  FrictionIteration friction;           ///< friction in proportion to loads

  // What comes out, beside `tree`.
  std::vector<JointLoad<T>> loads;  ///< per joint
  std::vector<T> drive_forces;      ///< per drive [N], [N m]
  Wrench<T> hand;                   ///< w_d at Go, world axes
  /// Of duals: how fast the loops open with the parameter as the pose stands still, and how fast
  /// they do although it goes along, which is nothing where the parameter is free to change.
  LoopOpening closing, opening;  ///< lengths over the characteristic length
  double unresisted = 0;         ///< largest force along an idle freedom without inertia [N], [N m]
  T power, power_gap, power_size, closure;  ///< power_gap: of the balance; power_size: its terms
  bool jammed = false;                      ///< as PoseState::jammed
  int locking_joint = -1;                   ///< as PoseState::locking_joint
  bool held_by_friction = false;            ///< as PoseState::held_by_friction

 private:
  LoadWorkspace(const LoadModel& model, const Design<T>& design, const TreeDesign<T>& placed);
};

}  // namespace vmech
