#include "hw_interface/free_motion.h"

#include <cmath>
#include <cstdlib>

#include "vmech/base/linear_algebra/linear_algebra.h"
#include "vmech/dynamics/in_hand/grasped_mechanism.h"
#include "vmech/dynamics/rigid_body/newton_euler.h"
#include "vmech/kinematics/loops/assembly.h"
#include "vmech/kinematics/loops/loops.h"
#include "vmech/kinematics/tree/forward_kinematics.h"

namespace vmech {
namespace {

constexpr double kStep = 1e-3;  // [m]
constexpr double kLever = 0.1;  // [m]

void Close(const KinematicTree& tree, VectorXd* q) {
  if (!Assemble(tree, {}, q).closed) std::abort();
}

/// dq/ds, in the sense of `before`.
VectorXd Tangent(const KinematicTree& tree, const VectorXd& q, const VectorXd& before,
                 GraspedMechanism* pose) {
  const MatrixXd N = FreeVelocities(tree, q);
  const VectorXd way = N * (N.transpose() * before);
  pose->Set(q);
  const Vector6d V = pose->J() * way;
  return way / std::hypot(V.head<3>().norm(), kLever * V.tail<3>().norm());
}

}  // namespace

MatrixXd FreeVelocities(const KinematicTree& tree, const VectorXd& q) {
  constexpr double kRank = 1e-9;
  if (tree.loops.empty()) return MatrixXd::Identity(tree.nv, tree.nv);
  GraspedMechanism pose(tree, GraspFrame{});
  pose.Set(q);
  return FindNullSpace(pose.C(), kRank).basis;
}

FreeMotion::FreeMotion(const KinematicTree& tree, const GraspFrame& grasp, const VectorXd& q,
                       double reach) {
  GraspedMechanism pose(tree, grasp);
  const int steps = static_cast<int>(std::ceil(reach / kStep));
  const VectorXd start = FreeVelocities(tree, q).col(0);
  std::vector<double> way(2 * steps + 1), inertia(2 * steps + 1);
  std::vector<Posed> frames(2 * steps + 1);
  for (const int side : {-1, 1}) {
    VectorXd here = q, tangent = Tangent(tree, here, side * start, &pose);
    for (int i = 0; i <= steps; ++i) {
      const int row = steps + side * i;
      way[row] = side * i * kStep;
      pose.Set(here);
      frames[row] = pose.X_WG();
      inertia[row] = tangent.dot(MassMatrix(tree, here) * tangent);
      // The midpoint rule; the pose stays on the track, s is good to 1e-6 of it.
      VectorXd middle = here;
      MoveCoordinates(tree, 0.5 * kStep * tangent, &middle);
      Close(tree, &middle);
      tangent = Tangent(tree, middle, tangent, &pose);
      MoveCoordinates(tree, kStep * tangent, &here);
      Close(tree, &here);
      tangent = Tangent(tree, here, tangent, &pose);
    }
  }
  track_ = HandLaw::Table(way, frames);
  inertia_ = MotionLaw::Table(way, inertia);
}

double FreeMotion::InertiaForce(double s, double rate, double acceleration) const {
  const MotionSample m = inertia_.At(s);
  return m.position * acceleration + 0.5 * m.velocity * rate * rate;
}

}  // namespace vmech
