#pragma once

#include "vmech/hw_interface/audit/audit_report.h"
#include "vmech/hw_interface/audit/audited_pose.h"

namespace vmech {

/// What the joints' wrenches of a tick say of every link and of the motions that they leave free.
class LinkBalance {
 public:
  /// Keeps a reference to the tree. `period`: of the loop [s].
  LinkBalance(const KinematicTree& tree, double period);

  /// The wrenches of a tick at a pose, with the velocities that the coordinates have.
  void TakeJoints(const AuditedPose& at, const std::vector<Wrenchd>& joints, const VectorXd& v);
  /// What a hand exerts on a link, about its Go in the world.
  void TakeHand(int node, const Vector3d& p_WGo, const Vector6d& w);
  /// A step by momenta, dh/dt = net wrench: by what share of the largest force the worst link is
  /// off.
  double OffInStep(const AuditedPose& before, const AuditedPose& now);
  /// At one instant, of all links but `held`, which an unknown wrench acts on.
  double OffAt(const AuditedPose& at, int held);

  // Of the joints taken last.
  double along() const { return along_; }            ///< constraints along free motions, as a share
  double joint_work() const { return joint_work_; }  ///< of all joints of the tree in a period [J]
  double constraint_work() const { return constraint_work_; }  ///< of bare ones, sizes [J]
  double corrected() const { return corrected_; }  ///< work of what OffInStep leaves open [J]
  /// Forces of joints and weights times the ways of their links in a period [J].
  double moved() const { return moved_; }

 private:
  double AlongCutFreedoms(int joint, const Wrenchd& w) const;
  Screw WeightOf(const AuditedPose& at, size_t node) const;

  const KinematicTree& tree_;
  double period_;
  std::vector<Screw> net_, wrenches_;  // on node i at i + 1; of the joints
  double largest_ = 0;                 // force of all ticks [N]
  double along_ = 0, joint_work_ = 0, constraint_work_ = 0;
  double corrected_ = 0, moved_ = 0;
};

}  // namespace vmech
