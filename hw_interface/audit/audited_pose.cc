#include "vmech/hw_interface/audit/audited_pose.h"

#include <Eigen/Cholesky>

#include "vmech/base/linear_algebra/linear_algebra.h"
#include "vmech/base/screw_algebra.h"
#include "vmech/kinematics/loops/dimensionless_loops.h"
#include "vmech/kinematics/loops/loops.h"
#include "vmech/kinematics/tree/forward_kinematics.h"

namespace vmech {

AuditedPose::AuditedPose(const KinematicTree& tree)
    : ws(tree),
      inertias(tree),
      joints(tree.mechanism.joints.size()),
      needed(tree.nodes.size() + 1),
      inertial(VectorXd::Zero(tree.nv)),
      heavy(inertial),
      sprung(inertial) {}

void AuditedPose::Set(const KinematicTree& tree, const VectorXd& at, const VectorXd& v) {
  q = at;
  ForwardKinematics(tree, q.data(), &ws);
  ForwardVelocities(tree, v.data(), &ws);
  LoopErrors(tree, &ws);
  BodyInertias(tree, ws, &inertias);
  JointFrames(tree, ws, &joints);
  closure = LargestLoopError(tree, ws);
  kinetic = KineticEnergy(tree, inertias, ws);
  weight = WeightEnergy(tree.mechanism.gravity_W, inertias);
  momenta.clear();
  for (size_t i = 0; i < ws.nodes.size(); ++i) {
    momenta.push_back(i == 0 ? Screw{} : inertias.bodies[i] * ws.nodes[i].V);
  }
}

void AuditedPose::Accelerate(const KinematicTree& tree, const PassiveJoints& passive,
                             const VectorXd& actual, const VectorXd& rate, const MatrixXd& idle) {
  const VectorXd zero = VectorXd::Zero(tree.nv);
  sprung.setZero();
  passive.AddForces(q, actual, &sprung);
  const auto forces = [&](const Vector3d& gravity, const VectorXd& acceleration, VectorXd* tau) {
    SetGravity(gravity, &ws);
    ForwardAccelerations(tree, acceleration.data(), &ws);
    NewtonEuler<double>(tree, inertias, nullptr, &ws, tau->data());
  };
  VelocityProducts(tree, &ws);
  GyroscopicWrenches(tree, inertias, &ws);
  VectorXd all = zero;
  forces(Vector3d::Zero(), rate, &inertial);
  forces(tree.mechanism.gravity_W, rate, &all);
  heavy = all - inertial;
  if (idle.cols() > 0) {
    const VectorXd released = rate - idle * (idle.transpose() * (all + sprung));
    forces(Vector3d::Zero(), released, &inertial);
  } else {
    forces(Vector3d::Zero(), rate, &inertial);
  }
  for (size_t i = 1; i < needed.size(); ++i) {
    needed[i] = inertias.bodies[i] * ws.nodes[i].A + ws.nodes[i].p;
  }
}

MatrixXd IdleMotionsOf(const KinematicTree& tree, const GraspFrame& grasp, const VectorXd& q) {
  constexpr double kMoved = 1e-6, kNoInertia = 1e-10;
  TreeWorkspace<double> ws(tree);
  ForwardKinematics(tree, q.data(), &ws);
  Matrix6Xd J(6, tree.nv);
  GraspJacobian(tree, ws, grasp.node, grasp.X_BG, &J);
  J.topRows<3>() /= tree.length;
  const int seen = grasp.kind == GraspKind::kPoint ? 3 : 6;
  const MatrixXd C = DimensionlessLoopJacobian(tree, q);
  MatrixXd A(seen + C.rows(), tree.nv);
  A << J.topRows(seen) * VelocityScale(tree).asDiagonal(), C;
  MatrixXd Z = VelocityScale(tree).asDiagonal() * FindNullSpace(A, kMoved).basis;
  if (Z.cols() == 0) return Z;
  const MatrixXd M = MassMatrix(tree, q), H = Z.transpose() * M * Z;
  const MatrixXd without = FindKernel(H, kNoInertia * M.diagonal().maxCoeff());
  if (without.cols() > 0) Z = Z * FindNullSpace(without.transpose(), 0.5).basis;
  if (Z.cols() == 0) return Z;
  const Eigen::LLT<MatrixXd> factor(Z.transpose() * M * Z);
  return factor.matrixL().solve(Z.transpose()).transpose();
}

}  // namespace vmech
