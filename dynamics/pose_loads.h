#pragma once

#include <optional>
#include <vector>

#include "vmech/dynamics/load_study.h"
#include "vmech/dynamics/reactions.h"
#include "vmech/kinematics/closure.h"
#include "vmech/kinematics/kinematic_tree.h"

namespace vmech {

/// Everything about a study that does not change from pose to pose. Immutable.
struct LoadModel {
  KinematicTree tree;
  CoordinatePartition partition;
  std::vector<JointCompliance> compliances;
  std::vector<ExternalLoad> external;
  std::vector<JointDrive> drives;
  std::optional<HandDrive> hand;
  Vector6d hand_stiffness = Vector6d::Ones();  ///< K of the hand, diagonal
  ReactionRule rule = ReactionRule::kStiffness;
  bool has_passive = false;
  bool has_load_friction = false;
};

/// Where the mechanism is and how it is driven at one pose.
struct PoseInput {
  double time = 0;
  VectorXd q;                           ///< closed [nq]
  std::vector<MotionSample> drives;     ///< of each joint drive
  HandSample hand;                      ///< if a hand drives
  std::vector<Vector3d> cut_positions;  ///< coordinates of each loop's cut joint, unwrapped
};

/// Memory for one thread, for one model that must outlive it.
struct LoadWorkspace {
  explicit LoadWorkspace(const LoadModel& model);

  TreeWorkspace<double> tree;
  DependentSolver dependents;
  ReactionSolver reactions;
  std::vector<JointState> joints;
  std::vector<Wrenchd> applied;      ///< per node about Bo, from outside
  std::vector<Wrenchd> cut_passive;  ///< per loop: springs and friction of the cut joint, in F
  VectorXd v, vdot;
  VectorXd tau;      ///< needed along each freedom
  VectorXd passive;  ///< supplied by springs and friction
  VectorXd open;     ///< what is left for drives and multipliers
  VectorXd mu;       ///< multipliers of the cut joints
  MatrixXd motions;  ///< [nv, independent]: free motions, where the hand or idle freedoms need them
  std::vector<Vector3d> friction_load, friction_residual;  ///< per joint, of the friction iteration
  std::vector<Wrenchd> external_W;  ///< the external loads at this pose about their points, world
};

/// Velocities, accelerations, drive forces and the wrench of every joint at one closed pose, from
/// scratch: the same input gives the same bits. `out` keeps its memory between calls. Everything in
/// PoseLoads but `links`. Returns false at a dead centre, where the drive does not determine the
/// motion; out is then not to be used.
[[nodiscard]] bool EvaluatePoseLoads(const LoadModel& model, const PoseInput& input,
                                     LoadWorkspace* ws, PoseLoads* out);

/// Motion of every link's drawing frame at the pose last evaluated.
void EvaluateLinkMotions(const LoadModel& model, const LoadWorkspace& ws, PoseLoads* out);

/// Makes room in `out` for a model's results.
void SizePoseLoads(const LoadModel& model, PoseLoads* out);

}  // namespace vmech
