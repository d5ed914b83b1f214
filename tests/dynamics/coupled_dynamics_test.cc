#include "vmech/dynamics/in_hand/coupled_dynamics.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "support/examples.h"
#include "vmech/dynamics/in_hand/hand_dynamics.h"

namespace vmech {
namespace {

constexpr double kStep = 1e-3;

HandCoupling Coupling(double stiffness, double damping) {
  constexpr double kLever2 = 0.01;
  HandCoupling coupling;
  coupling.stiffness << Vector3d::Constant(stiffness), Vector3d::Constant(kLever2 * stiffness);
  coupling.damping << Vector3d::Constant(damping), Vector3d::Constant(kLever2 * damping);
  return coupling;
}

/// A mechanism at its start on a spring to a hand.
struct Coupled {
  Coupled(const Mechanism& mechanism, const std::string& grasp, const HandCoupling& coupling,
          double step = kStep)
      : tree(BuildKinematicTree(mechanism)),
        frame(GraspFrameOf(tree, FindGrasp(mechanism, grasp))),
        dynamics(tree, frame, coupling, step, Start(tree)),
        X_WH(dynamics.X_WG()) {}

  static VectorXd Start(const KinematicTree& tree) {
    VectorXd q = StartCoordinates(tree);
    EXPECT_TRUE(Assemble(tree, {}, &q).closed);
    return q;
  }
  void Run(int steps) {
    for (int k = 0; k < steps; ++k) {
      ASSERT_EQ(dynamics.Step(X_WH, Vector6d::Zero()), CoupledStatus::kMoved) << k;
    }
  }

  KinematicTree tree;
  GraspFrame frame;
  CoupledDynamics dynamics;
  Posed X_WH;
};

TEST(CoupledDynamics, LetLooseThePendulumSwingsInItsPeriod) {
  Mechanism crank = Example("crank");
  crank.joints[0].start = {-0.5 * std::numbers::pi + 0.05};
  Coupled loose(crank, "handle", HandCoupling{}, 1e-4);
  // T = 2 pi (I / m g l)^1/2 for small swings; half of it until it turns.
  const double inertia = 0.006 + 0.8 * 0.15 * 0.15;
  const double half = std::numbers::pi * std::sqrt(inertia / (0.8 * 9.81 * 0.15));
  int turned = 0;
  for (int k = 10; turned == 0 && k < 20000; ++k) {
    loose.Run(1);
    if (loose.dynamics.v()[0] > 0) turned = k - 9;
  }
  EXPECT_NEAR(turned * 1e-4, half, 2e-3 * half);
}

class EveryCoupledExample : public testing::TestWithParam<std::string> {};

TEST_P(EveryCoupledExample, LetLooseKeepsItsEnergyAndItsLoopsClosed) {
  Coupled loose(Example(GetParam()), "handle", HandCoupling{}, 1e-4);
  const double start = loose.dynamics.Energy();
  double kinetic = 0, worst = 0, closure = 0;
  for (int k = 0; k < 2000; ++k) {
    loose.Run(1);
    worst = std::max(worst, std::abs(loose.dynamics.Energy() - start));
    kinetic = std::max(kinetic, loose.dynamics.v().norm());
    closure = std::max(closure, loose.dynamics.closure());
  }
  EXPECT_GT(kinetic, 0.5);
  // The step is of first order: what is left is in proportion to it and to the speed.
  EXPECT_LT(worst, 0.01 * std::abs(start));
  EXPECT_LT(closure, 1e-10);
}

TEST_P(EveryCoupledExample, AtRestIsThatOfTheHandDynamics) {
  Coupled held(Example(GetParam()), "handle", Coupling(1e6, 1e5));
  held.Run(3000);
  const Vector6d K = Coupling(1e6, 0).stiffness;
  HandDynamics statics(held.tree, held.frame, K, held.dynamics.q());
  statics.SetPose(held.dynamics.q());
  ASSERT_TRUE(statics.Evaluate(Vector6d::Zero(), Vector6d::Zero()));
  // The mechanism sags on the spring along its free motion, which is a little curved.
  constexpr double kSag = 2e-3;
  const double scale = statics.w_d().norm();
  EXPECT_GT(scale, 1);
  EXPECT_LT((held.dynamics.w() - statics.w_d()).norm(), kSag * scale);
  for (size_t j = 0; j < statics.joints().size(); ++j) {
    const Vector6d difference = (held.dynamics.joints()[j] - statics.joints()[j]).Stacked();
    EXPECT_LT(difference.norm(), kSag * (scale + statics.joints()[j].Stacked().norm())) << j;
  }
}

INSTANTIATE_TEST_SUITE_P(Examples, EveryCoupledExample,
                         testing::Values("crank", "two-link-arm", "slider-crank", "four-bar",
                                         "rssr", "bennett", "stewart-gough"),
                         [](const auto& info) { return TestName(info.param); });

TEST(CoupledDynamics, SliderCrankTurnsThroughItsDeadCentresOnItsBranch) {
  Mechanism mechanism = Example("slider-crank");
  mechanism.gravity_W.setZero();
  const int crank = FindLink(mechanism, "crank");
  mechanism.grasps.push_back({"pin", crank, {}, GraspKind::kPoint});
  mechanism.grasps.back().X_LG = mechanism.links[crank].anchors[1].X_LA;
  Coupled held(mechanism, "pin", Coupling(2e4, 100));
  const int main = CoordinateIndex(held.tree, FindJoint(mechanism, "main"), 0);
  const double start = held.dynamics.q()[main];
  Posed X_WH;
  for (int k = 0; k < 4000; ++k) {
    // Half a second to come to speed, then a turn a second.
    const double t = k * kStep;
    const double angle = 2 * std::numbers::pi * (t < 0.5 ? t * t : t - 0.25);
    X_WH.p = Eigen::AngleAxisd(angle, Vector3d::UnitZ()) * held.X_WH.p;
    ASSERT_EQ(held.dynamics.Step(X_WH, Vector6d::Zero()), CoupledStatus::kMoved) << k;
    ASSERT_LT(held.dynamics.closure(), 1e-10);
  }
  EXPECT_NEAR(held.dynamics.q()[main] - start, 2 * std::numbers::pi * 3.75, 0.2);
  EXPECT_LT((held.dynamics.X_WG().p - X_WH.p).norm(), 5e-3);
}

TEST(CoupledDynamics, JointStopsAtItsLimitAndComesBackFreely) {
  Mechanism crank = Example("crank");
  crank.gravity_W.setZero();
  const double start = crank.joints[0].start[0];
  crank.joints[0].upper = {start + 0.1};
  Coupled held(crank, "tip", Coupling(1000, 10));
  const Vector3d across(-held.X_WH.p.y(), held.X_WH.p.x(), 0);
  held.X_WH.p += across;  // far beyond the limit
  held.Run(500);
  EXPECT_TRUE(held.dynamics.at_limit());
  EXPECT_NEAR(held.dynamics.q()[0], start + 0.1, 1e-4);
  held.X_WH.p -= 1.2 * across;
  held.Run(500);
  EXPECT_FALSE(held.dynamics.at_limit());
  EXPECT_LT(held.dynamics.q()[0], start);
}

TEST(CoupledDynamics, CouplingSlipsAtItsLargestForce) {
  HandCoupling coupling = Coupling(1000, 10);
  coupling.max_force = 3;
  Mechanism crank = Example("crank");
  crank.gravity_W.setZero();
  Coupled held(crank, "tip", coupling);
  held.X_WH.p += 0.1 * held.X_WH.p.normalized();
  held.Run(100);
  EXPECT_TRUE(held.dynamics.slipping());
  EXPECT_NEAR(held.dynamics.w().head<3>().norm(), 3, 1e-12);
}

TEST(CoupledDynamics, FreedomsThatTheGraspDoesNotReachSwing) {
  Mechanism arm = Example("two-link-arm");
  arm.grasps[FindGrasp(arm, "handle")].link = FindLink(arm, "upper-arm");
  Coupled held(arm, "handle", Coupling(1e5, 100));
  const int elbow = CoordinateIndex(held.tree, FindJoint(arm, "elbow"), 0);
  const double start = held.dynamics.q()[elbow];
  held.Run(300);
  EXPECT_GT(std::abs(held.dynamics.q()[elbow] - start), 0.1);
}

TEST(CoupledDynamics, LosesEnergyToAHandThatKeepsStill) {
  for (const char* name : {"four-bar", "bennett", "stewart-gough"}) {
    Coupled held(Example(name), "handle", Coupling(3e4, 100));
    held.X_WH.p += Vector3d(0.01, -0.005, 0.02);
    held.Run(1);
    const double start = held.dynamics.Energy();
    double before = start, most = 0;
    for (int k = 0; k < 2000; ++k) {
      held.Run(1);
      most = std::max(most, held.dynamics.Energy() - before);
      before = held.dynamics.Energy();
    }
    EXPECT_LT(before, start) << name;
    EXPECT_LT(most, 1e-3 * (start - before)) << name;
  }
}

TEST(CoupledDynamics, RefusesAGainOutOfRange) {
  HandCoupling coupling;
  coupling.stiffness[1] = -1;
  EXPECT_THROW(Coupled(Example("crank"), "tip", coupling), std::invalid_argument);
}

/// How far a hand draws a door in 0.3 s that is drawn askew, with gravity.
double TurnOfDoor(double angle) {
  Mechanism door = Example("door-on-two-hinges");
  const Posed askew(Eigen::AngleAxisd(angle, Vector3d(2, -1, 2) / 3).toRotationMatrix(),
                    Vector3d(0.3, -angle, 0.7));
  for (Link& link : door.links) {
    for (Anchor& anchor : link.anchors) anchor.X_LA = askew * anchor.X_LA;
    MassProperties& body = link.mass_properties;
    body = {body.mass, askew * body.p_LoLcm, askew.R * body.I_Lcm * askew.R.transpose()};
  }
  door.grasps[0].X_LG = askew * door.grasps[0].X_LG;
  door.gravity_W = askew.R * door.gravity_W;
  Coupled coupled(door, door.grasps[0].name, Coupling(500, 50));
  coupled.X_WH.p += askew.R * Vector3d(0, 0.05, 0);
  coupled.Run(300);
  return coupled.dynamics.q()[0];
}

// Of a second hinge that is drawn askew the equations are rounding instead of zeros.
TEST(CoupledDynamics, DrawsADoorOnTwoHingesHoweverTheyLie) {
  const double turn = TurnOfDoor(0);
  EXPECT_GT(turn, 0.01);
  for (const double angle : {0.4, 1.1, 1.9}) EXPECT_NEAR(TurnOfDoor(angle), turn, 1e-9) << angle;
}

}  // namespace
}  // namespace vmech
