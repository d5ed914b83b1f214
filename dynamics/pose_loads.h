#pragma once

#include <optional>
#include <vector>

#include "vmech/dynamics/contact_friction.h"
#include "vmech/dynamics/friction_iteration.h"
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
  double rounding = 0;  ///< of the mechanism's figures, as AssembledMechanism::correction
  /// Freedoms that neither drives nor the hand determine and that no load depends on, such as the
  /// spin of a rod between two spherical joints.
  int idle = 0;
  /// Moments of inertia up to here are rounding [kg m^2]: what they resist does not move.
  double no_inertia = 0;
  bool idle_is_held = false;  ///< idle freedoms do not move at all
  bool has_passive = false;
  bool has_dry_friction = false;   ///< constant, or in proportion to loads
  bool has_load_friction = false;  ///< in proportion to loads
};

/// A study's motion, pose by pose.
struct Motion {
  std::vector<double> times;
  std::vector<double> coordinates;      ///< [poses * nq] of closed poses
  std::vector<MotionSample> drives;     ///< [poses * drives]
  std::vector<HandSample> hand;         ///< [poses] if a hand drives
  std::vector<Vector3d> cut_positions;  ///< [poses * loops] of the cut joints, unwrapped
  /// The largest speed of any drive or of the hand [rad/s], lengths divided by the characteristic
  /// length: what rounding of velocities is measured by.
  double speed = 0;

  size_t size() const { return times.size(); }
  Eigen::Map<const VectorXd> q(size_t pose) const {
    const size_t nq = coordinates.size() / times.size();
    return {coordinates.data() + pose * nq, static_cast<Eigen::Index>(nq)};
  }
};

/// A contact at rest that would slide if the drives that stand still crept.
struct RestingContact {
  int joint = -1;
  Eigen::Matrix3Xd creep;    ///< [3, standing drives] rates of the joint; zero but in this contact
  Eigen::Matrix3Xd limited;  ///< the same, each rate times the limit of its friction
  double weight = 0;
};

/// What a joint does and carries, in the axes of the anchor on its first link.
template <typename T>
struct JointLoad {
  Wrench<T> W_F;        ///< what the first link exerts on the second, about the second anchor
  Vector3<T> position;  ///< coordinates of its freedoms
  Vector3<T> rate;
};

/// Memory for one thread, for one model that must outlive it. T is double for one pose at a time,
/// or Packet for four in a row.
template <typename T>
struct LoadWorkspace {
  using VectorX = Eigen::Matrix<T, Eigen::Dynamic, 1>;

  explicit LoadWorkspace(const LoadModel& model);

  TreeWorkspace<T> tree;
  DependentSolver<T> dependents;
  ReactionSolver<T> reactions;
  std::vector<JointState<T>> joints;
  std::vector<Wrench<T>> applied;      ///< per node about Bo, from outside
  std::vector<Wrench<T>> cut_passive;  ///< per loop: springs and friction of the cut joint, in F
  std::vector<Vector3<T>> sliding;     ///< per joint: its rates, zero where it rests
  std::vector<Vector3<T>> along;       ///< per joint: springs and friction along its freedoms
  std::vector<Wrench<T>> external_W;   ///< the external loads about their points, world axes
  VectorX q, v, vdot;
  VectorX tau;       ///< needed along each freedom
  VectorX passive;   ///< supplied by springs and friction
  VectorX open;      ///< what is left for drives and multipliers
  VectorX mu;        ///< multipliers of the cut joints
  MatrixXd motions;  ///< [nv, independent]: free motions, where the hand or idle freedoms need them
  MatrixXd idle_motions;  ///< [nv, idle]: those of them that are idle
  MatrixXd creep;         ///< [nv, standing drives]: the motion as each of them begins to move
  std::vector<Vector3d> creep_rates;  ///< [standing drives * joints]
  std::vector<RestingContact> resting;
  VectorXd holding;  ///< [standing drives] y of resting_friction.h
  int holding_passes = 0;
  FrictionIteration friction;

  // What comes out, beside `tree`.
  std::vector<JointLoad<T>> loads;  ///< per joint
  std::vector<T> drive_forces;
  Wrench<T> hand;         ///< w_d at Go, world axes
  double unresisted = 0;  ///< largest force along an idle freedom without inertia [N], [N m]
  T power, power_gap, power_size, closure;  ///< power_gap: of the balance; power_size: its terms
  bool jammed = false;
  int locking_joint = -1;
  bool held_by_friction = false;
};

/// Can a packet of poses be evaluated at once? Not where the hand, idle freedoms or friction under
/// load ask for dense systems or iterations of each pose's own.
bool RunsInPackets(const LoadModel& model);

/// Velocities, accelerations, drive forces and the wrench of every joint at the closed poses
/// `pose`, `pose` + 1, ... (as many as T has lanes), from scratch: the same input gives the same
/// bits. Returns false if one of them is a dead centre, where the drive does not determine the
/// motion, or if one of a packet is a pose at rest, whose friction is found pose by pose; what ws
/// holds is then not to be used.
template <typename T>
[[nodiscard]] bool EvaluatePoseLoads(const LoadModel& model, const Motion& motion, size_t pose,
                                     LoadWorkspace<T>* ws);

/// Copies what was computed last to poses[0], poses[1], ... (as many as T has lanes), with the
/// motion of every link if wanted. They keep their memory.
template <typename T>
void StorePoseLoads(const LoadModel& model, const Motion& motion, size_t pose,
                    const LoadWorkspace<T>& ws, bool link_motions, PoseLoads* poses);

}  // namespace vmech
