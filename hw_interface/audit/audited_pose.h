#pragma once

#include <vector>

#include "vmech/dynamics/in_hand/passive_joints.h"
#include "vmech/dynamics/reactions/joint_wrenches.h"
#include "vmech/dynamics/rigid_body/newton_euler.h"
#include "vmech/kinematics/tree/kinematic_tree.h"

namespace vmech {

/// A recorded mechanism in one tick, computed anew from its coordinates and velocities.
struct AuditedPose {
  explicit AuditedPose(const KinematicTree& tree);  ///< takes the numbers of the tree

  /// At the coordinates `at`, with the velocities v of its inertia.
  void Set(const KinematicTree& tree, const VectorXd& at, const VectorXd& v);
  /// After Set, in the paper's way: with the rate of v, and `idle`, motions that nothing drives
  /// [nv, any]; `actual`: the velocities of its dampers.
  void Accelerate(const KinematicTree& tree, const PassiveJoints& passive, const VectorXd& actual,
                  const VectorXd& rate, const MatrixXd& idle);

  TreeWorkspace<double> ws;                ///< twists V and, after Accelerate, accelerations A
  TreeInertias<double> inertias;           ///< about the reference point
  std::vector<JointState<double>> joints;  ///< frames
  VectorXd q;                              ///< coordinates [nq]
  // Of the nodes, about the reference point; node i at i + 1.
  std::vector<Screw> momenta;  ///< I V
  std::vector<Screw> needed;   ///< what has to act beside the weight, after Accelerate
  double closure = 0;          ///< of the loops, lengths over the mechanism's
  double kinetic = 0;          ///< [J]
  double weight = 0;           ///< energy of the weights [J]
  // Generalised forces [nv], after Accelerate:
  VectorXd inertial;  ///< that its motion takes
  VectorXd heavy;     ///< that its weight takes
  VectorXd sprung;    ///< that springs and dampers take
};

/// The motions of a closed pose that neither loops nor a hand see, of those that have inertia:
/// orthonormal in the metric of M, M Z'M Z = 1 [nv, any].
MatrixXd IdleMotionsOf(const KinematicTree& tree, const GraspFrame& grasp, const VectorXd& q);

}  // namespace vmech
