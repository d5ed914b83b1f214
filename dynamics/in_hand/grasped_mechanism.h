#pragma once

#include <span>
#include <vector>

#include "vmech/dynamics/in_hand/held_design.h"
#include "vmech/dynamics/reactions/joint_wrenches.h"
#include "vmech/dynamics/rigid_body/newton_euler.h"
#include "vmech/kinematics/inverse/inverse_kinematics.h"

namespace vmech {

/// A mechanism in a hand, or in several, at one pose, with memory: the grasps' Jacobians J, the
/// loops' C, and what the joints carry. The common ground of HandDynamics and CoupledDynamics.
/// Where a hand is not named, the first is meant. Nothing allocates after construction.
class GraspedMechanism {
 public:
  /// Keeps a reference to the tree. `grasps`: of a hand each, at least one.
  GraspedMechanism(const KinematicTree& tree, std::span<const GraspFrame> grasps);
  /// The same in one hand.
  GraspedMechanism(const KinematicTree& tree, const GraspFrame& grasp)
      : GraspedMechanism(tree, std::span(&grasp, 1)) {}

  int hands() const noexcept { return static_cast<int>(grasps_.size()); }  ///< at least 1
  /// Another grasp frame, from the next Set on.
  void SetGrasp(const GraspFrame& grasp, int hand = 0) noexcept { grasps_[hand].frame = grasp; }
  /// The grasp frame by which a hand holds the mechanism now.
  const GraspFrame& grasp(int hand = 0) const noexcept { return grasps_[hand].frame; }

  /// Takes the numbers of another design, from the next Set on. A hand at its grasp of `from` is at
  /// that of `to`; another goes on holding its link where it does.
  void ChangeDesign(const HeldDesign& from, const HeldDesign& to) noexcept;

  /// Takes q [nq].
  void Set(const VectorXd& q) noexcept;
  /// The same from a workspace of the same tree, after ForwardKinematics and LoopErrors.
  void Set(const TreeWorkspace<double>& at_q) noexcept;
  /// The first half of Set, nodes and loop errors, as needed between two steps of a closure.
  void SetLoops(const VectorXd& q) noexcept;
  /// The other half: grasp frame, Jacobians and inertias.
  void SetJacobians() noexcept;

  Posed X_WG(int hand = 0) const noexcept;         ///< grasp frame in the world, of the last Set
  Frame grasp_frame(int hand = 0) const noexcept;  ///< the same
  /// Where the grasp frame is, known after SetLoops already.
  Frame FindGraspFrame(int hand = 0) const noexcept;
  Posed X_WB(int node) const noexcept;  ///< frame of a node of the tree in the world
  Matrix6Xd J() const;                  ///< [6, nv], V_WG = J v
  /// B [8, nv] = root J with zeros below either three rows: B'B = J' root^2 J.
  void ComputeWeightedJacobian(const Screw& root, MatrixXd* B, int hand = 0) const noexcept;
  /// [rows, nv], C v = 0; lengths over the characteristic length, padded with rows of zeros.
  const MatrixXd& C() const noexcept { return C_; }
  const VectorXd& e2() const noexcept { return e2_; }  ///< loop errors, scaled and padded like C

  // Twists and wrenches of the grasp frame: about Go.
  Screw Twist(const VectorXd& v, int hand = 0) const noexcept;  ///< J v
  /// tau += J'w
  void AddForces(const Screw& w, VectorXd* tau, int hand = 0) const noexcept;

  /// M [nv, nv], which was zero in the beginning.
  void ComputeMassMatrix(MatrixXd* M) noexcept;

  /// Takes v [nv].
  void SetVelocities(const VectorXd& v) noexcept;
  double KineticEnergy() const noexcept;  ///< at the velocities that were set last [J]
  /// M v [nv]; forgets the velocities.
  void ComputeMomenta(const VectorXd& v, VectorXd* momenta) noexcept;
  /// Takes v' = 0, and finds the accelerations that come of v alone; all that follows needs them.
  void ComputeVelocityProducts() noexcept;
  /// The same, and d = s C' v, scaled and padded like C.
  void ComputeLoopBias(double s, VectorXd* d) noexcept;
  /// The acceleration of Go for v' = 0.
  Screw GraspBias() const noexcept;
  /// Takes v' [nv].
  void SetAccelerations(const VectorXd& vdot) noexcept;
  /// M v' + h [nv].
  void ComputeForces(VectorXd* tau) noexcept;
  /// Joint by joint of the mechanism, what the first link exerts on the second about the second
  /// anchor's origin, axes of the first anchor, while every hand exerts its w at its Go and the
  /// loops the multipliers of M v' + h = J' w - C' mu.
  void LoadJoints(std::span<const Screw> w, const VectorXd& mu,
                  std::vector<Wrenchd>* joints) noexcept;

  /// The same where the cut joints exert `cut` on their second links, each about the origin of its
  /// second anchor, world axes.
  void LoadJoints(std::span<const Screw> w, const std::vector<Screw>& cut,
                  std::vector<Wrenchd>* joints) noexcept;

  // A loop cut through, paper eq. (4) to (6), about the origin of the cut joint's second anchor.
  /// B [8, nv], padded like that of ComputeWeightedJacobian: the second anchor moves by B v in the
  /// first.
  void ComputeCutRows(int loop, MatrixXd* B) const noexcept;
  Screw CutTwist(int loop, const VectorXd& v) const noexcept;  ///< B v

  /// Energy of the weights [J], zero with all centres of gravity at the height of the reference
  /// point.
  double WeightEnergy() const noexcept { return vmech::WeightEnergy(gravity_W_, inertias_); }

 private:
  struct Grasped {
    GraspFrame frame;
    Frame G;               // about the reference point
    std::vector<Screw> J;  // columns
  };

  Frame InWorld(const Frame& G) const noexcept;
  void ScaleLoopErrors() noexcept;
  void StartLoads(std::span<const Screw> w) noexcept;
  void LoadLoop(const Loop& loop, const Screw& W) noexcept;
  void FinishLoads(std::vector<Wrenchd>* joints) noexcept;

  const KinematicTree& tree_;
  Vector3d gravity_W_;
  std::vector<Grasped> grasps_;
  VectorXd row_scale_;
  TreeWorkspace<double> ws_;
  TreeInertias<double> inertias_;
  std::vector<JointState<double>> joints_;
  MatrixXd C_;
  VectorXd e2_;
  bool has_forces_ = false;  // ws_ has the F of the accelerations in it
};

}  // namespace vmech
