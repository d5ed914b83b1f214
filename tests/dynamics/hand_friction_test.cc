#include <gtest/gtest.h>

#include <cmath>

#include "one_joint.h"
#include "vmech/dynamics/in_hand/coupled_dynamics.h"
#include "vmech/dynamics/in_hand/hand_dynamics.h"

namespace vmech {
namespace {

constexpr double kFriction = 12;  // [N]

/// A block on a level table with constant friction, its anchors turned.
struct SlidingBlock {
  explicit SlidingBlock(double turn) : tree(BuildKinematicTree(Made(turn))) {}

  static Mechanism Made(double turn) {
    OneJoint block(JointType::kPlanar, {});
    block.turn = turn;
    block.joint.passive[0].coulomb = block.joint.passive[1].coulomb = kFriction;
    return block.Made();
  }

  KinematicTree tree;
  GraspFrame frame = GraspFrameOf(tree, 0);
  VectorXd q = StartCoordinates(tree);
};

TEST(HandFriction, OfABlockIsAgainstItsVelocityHoweverItsAnchorLies) {
  const Vector3d velocity = 0.5 * Vector3d(0.6, -0.8, 0);
  for (const double turn : {0.0, 0.4, 2.0}) {
    SlidingBlock block(turn);
    HandDynamics dynamics(block.tree, block.frame, Vector6d::Ones(), block.q);
    Vector6d V = Vector6d::Zero();
    V.head<3>() = velocity;
    dynamics.SetPose(block.q);
    ASSERT_TRUE(dynamics.Evaluate(V, Vector6d::Zero()));
    EXPECT_LT((dynamics.w_d().head<3>() - kFriction * velocity.normalized()).norm(), 1e-8);
  }
}

/// Where a block is after it was pulled aslant on a spring.
Vector3d Pulled(double turn) {
  SlidingBlock block(turn);
  HandCoupling coupling;
  coupling.stiffness << Vector3d::Constant(1000), Vector3d::Constant(10);
  coupling.damping << Vector3d::Constant(10), Vector3d::Constant(0.1);
  CoupledDynamics dynamics(block.tree, block.frame, coupling, 1e-3, block.q);
  Posed X_WH = dynamics.X_WG();
  X_WH.p += Vector3d(0.03, 0.04, 0);
  for (int i = 0; i < 60; ++i) {
    EXPECT_EQ(dynamics.Step(X_WH, Vector6d::Zero()), CoupledStatus::kMoved);
  }
  return dynamics.X_WG().p;
}

TEST(HandFriction, LetsABlockFollowItsPullStraight) {
  const Vector3d end = Pulled(0);
  EXPECT_GT(end.norm(), 0.005);
  EXPECT_NEAR(end.x() * 4 - end.y() * 3, 0, 1e-9);
  EXPECT_LT((Pulled(0.4) - end).norm(), 1e-9);
}

}  // namespace
}  // namespace vmech
