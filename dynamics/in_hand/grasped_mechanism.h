#pragma once

#include <vector>

#include "vmech/dynamics/reactions/joint_wrenches.h"
#include "vmech/dynamics/rigid_body/newton_euler.h"
#include "vmech/kinematics/inverse/inverse_kinematics.h"

namespace vmech {

/// A mechanism in a hand at one pose, with memory: the grasp's Jacobian J, the loops' C, and what
/// the joints carry. The common ground of HandDynamics and CoupledDynamics. Nothing allocates after
/// construction.
class GraspedMechanism {
 public:
  /// Keeps a reference to the tree.
  GraspedMechanism(const KinematicTree& tree, const GraspFrame& grasp);

  /// Another grasp frame, from the next Set on.
  void SetGrasp(const GraspFrame& grasp) noexcept { grasp_ = grasp; }
  const GraspFrame& grasp() const noexcept { return grasp_; }

  /// Takes q [nq].
  void Set(const VectorXd& q) noexcept;
  /// The same from a workspace of the same tree, after ForwardKinematics and LoopErrors.
  void Set(const TreeWorkspace<double>& at_q) noexcept;
  /// The first half of Set, nodes and loop errors, as needed between two steps of a closure.
  void SetLoops(const VectorXd& q) noexcept;
  /// The other half: grasp frame, Jacobians and inertias.
  void SetJacobians() noexcept;

  Posed X_WG() const noexcept;
  Frame grasp_frame() const noexcept;  ///< the same
  Posed X_WB(int node) const noexcept;
  Matrix6Xd J() const;  ///< [6, nv], V_WG = J v
  /// B [8, nv] = root J with zeros below either three rows: B'B = J' root^2 J.
  void ComputeWeightedJacobian(const Screw& root, MatrixXd* B) const noexcept;
  /// [rows, nv], C v = 0; lengths over the characteristic length, padded with rows of zeros.
  const MatrixXd& C() const noexcept { return C_; }
  const VectorXd& e2() const noexcept { return e2_; }  ///< loop errors, scaled and padded like C

  // Twists and wrenches of the grasp frame: about Go.
  Screw Twist(const VectorXd& v) const noexcept;                 ///< J v
  void AddForces(const Screw& w, VectorXd* tau) const noexcept;  ///< tau += J'w

  /// M [nv, nv], which was zero in the beginning.
  void ComputeMassMatrix(MatrixXd* M) noexcept;

  /// Takes v [nv].
  void SetVelocities(const VectorXd& v) noexcept;
  double KineticEnergy() const noexcept;  ///< at these [J]
  /// M v [nv]; forgets the velocities.
  void ComputeMomenta(const VectorXd& v, VectorXd* momenta) noexcept;
  /// Takes v' = 0, and finds what comes of v alone, as all that follows needs it.
  void ComputeVelocityProducts() noexcept { VelocityProducts(tree_, &ws_); }
  /// The same, and d = s C' v, scaled and padded like C.
  void ComputeLoopBias(double s, VectorXd* d) noexcept;
  /// The acceleration of Go for v' = 0.
  Screw GraspBias() const noexcept;
  /// Takes v' [nv].
  void SetAccelerations(const VectorXd& vdot) noexcept;
  /// M v' + h [nv].
  void ComputeForces(VectorXd* tau) noexcept;
  /// Joint by joint of the mechanism, what the first link exerts on the second about the second
  /// anchor's origin, axes of the first anchor, while a hand exerts w at Go and the loops the
  /// multipliers of M v' + h = J' w - C' mu.
  void LoadJoints(const Screw& w, const VectorXd& mu, std::vector<Wrenchd>* joints) noexcept;

  /// The same where the cut joints exert `cut` on their second links, each about the origin of its
  /// second anchor, world axes.
  void LoadJoints(const Screw& w, const std::vector<Screw>& cut,
                  std::vector<Wrenchd>* joints) noexcept;

  // A loop cut through, paper eq. (4) to (6), about the origin of the cut joint's second anchor.
  /// B [8, nv], padded like that of ComputeWeightedJacobian: the second anchor moves by B v in the
  /// first.
  void ComputeCutRows(int loop, MatrixXd* B) const noexcept;
  Screw CutTwist(int loop, const VectorXd& v) const noexcept;  ///< B v

  /// Zero with all centres of gravity at the height of the reference point [J].
  double WeightEnergy() const noexcept { return vmech::WeightEnergy(tree_, inertias_); }

 private:
  void ScaleLoopErrors() noexcept;
  void StartLoads(const Screw& w) noexcept;
  void LoadLoop(const Loop& loop, const Screw& W) noexcept;
  void FinishLoads(std::vector<Wrenchd>* joints) noexcept;

  const KinematicTree& tree_;
  GraspFrame grasp_;
  VectorXd row_scale_;
  TreeWorkspace<double> ws_;
  TreeInertias<double> inertias_;
  std::vector<JointState<double>> joints_;
  Frame G_;               // about the reference point
  std::vector<Screw> J_;  // columns
  MatrixXd C_;
  VectorXd e2_;
};

}  // namespace vmech
