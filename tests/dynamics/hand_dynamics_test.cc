#include "vmech/dynamics/in_hand/hand_dynamics.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <numbers>

#include "support/examples.h"
#include "vmech/base/rotation_error.h"
#include "vmech/dynamics/loads/load_result.h"
#include "vmech/dynamics/loads/load_study.h"
#include "vmech/dynamics/loads/run_load_study.h"
#include "vmech/kinematics/inverse/configuration_distance.h"
#include "vmech/kinematics/inverse/hand_tracker.h"
#include "vmech/kinematics/loops/assembly.h"
#include "vmech/kinematics/tree/forward_kinematics.h"

namespace vmech {
namespace {

/// A mechanism at its start, in a hand that moves it.
class Held {
 public:
  Held(const Mechanism& mechanism, const std::string& grasp)
      : tree(BuildKinematicTree(mechanism)),
        index(FindGrasp(mechanism, grasp)),
        frame(GraspFrameOf(tree, index)),
        q(AssembledStart(tree)),
        ws(tree) {
    ForwardKinematics(tree, q.data(), &ws);
    X_WG = PoseInWorld(ws, frame.node, frame.X_BG);
  }

  static VectorXd AssembledStart(const KinematicTree& tree) {
    VectorXd q = StartCoordinates(tree);
    EXPECT_TRUE(Assemble(tree, {}, &q).closed);
    return q;
  }

  KinematicTree tree;
  int index;
  GraspFrame frame;
  VectorXd q;
  TreeWorkspace<double> ws;
  Posed X_WG;
};

TEST(HandDynamics, CrankIsThatOfThePaperCase) {
  // Reference case of paper eq. (9), (10): crank at 40 degrees, 3 rad/s, 5 rad/s^2.
  const Held held(Example("crank"), "handle");
  HandDynamics dynamics(held.tree, held.frame, Vector6d::Ones(), held.q);
  const double angle = 40 * std::numbers::pi / 180;
  const Vector3d along(std::cos(angle), std::sin(angle), 0), across(-along.y(), along.x(), 0);
  Vector6d V, A;
  V << 0.3 * 3 * across, 0, 0, 3;
  A << 0.3 * 5 * across - 0.3 * 9 * along, 0, 0, 5;
  dynamics.SetPose(held.q);
  ASSERT_TRUE(dynamics.Evaluate(V, A));
  const Vector6d& w_d = dynamics.w_d();
  EXPECT_NEAR(w_d[0], -0.18076853850973498, 1e-9);
  EXPECT_NEAR(w_d[1], 0.2154315551969815, 1e-9);
  EXPECT_NEAR(w_d[5], 0.9374197416877625, 1e-9);
}

class EveryHeldExample : public testing::TestWithParam<std::string> {
 protected:
  /// The hand sets off from the grasp frame on a parabola.
  HandLaw Motion() {
    std::vector<Posed> poses;
    for (const double t : {0.0, 0.1, 0.2}) {
      const Vector3d turn = (0.8 * t + 2 * t * t) * Vector3d(0.3, -0.5, 0.8);
      poses.push_back({Eigen::AngleAxisd(turn.norm(), Vector3d(0.3, -0.5, 0.8).normalized())
                               .toRotationMatrix() *
                           held_.X_WG.R,
                       held_.X_WG.p + t * Vector3d(0.5, 0.3, -0.4) + t * t * Vector3d(-1, 2, 1)});
    }
    return HandLaw::Table({0, 0.1, 0.2}, poses);
  }

  Held held_{Example(GetParam()), "handle"};
  Vector6d K_ = (Vector6d() << 500, 500, 500, 2, 2, 2).finished();
};

TEST_P(EveryHeldExample, AgreesWithTheLoadStudyInAllThatIsCertain) {
  const HandLaw law = Motion();
  LoadStudy study;
  study.mechanism = held_.tree.mechanism;
  study.hand = HandDrive{held_.index, law, K_};
  study.times = {0};
  study.rule = ReactionRule::kMinimumNorm;
  const LoadStudyResult result = RunLoadStudy(study);
  const auto& expected = result.poses[0];

  HandDynamics dynamics(held_.tree, held_.frame, K_, held_.q);
  const HandSample hand = law.At(0);
  dynamics.SetPose(held_.q);
  ASSERT_TRUE(dynamics.Evaluate(hand.V_WH, hand.A_WH));
  // Three solves with a loop weight of 1e4.
  constexpr double kPrecision = 1e-7;
  const double scale = 1 + expected.hand.Stacked().cwiseAbs().maxCoeff();
  EXPECT_LT((dynamics.w_d() - expected.hand.Stacked()).norm(), kPrecision * scale);
  int certain = 0;
  for (size_t j = 0; j < dynamics.joints().size(); ++j) {
    const Vector6d difference = (dynamics.joints()[j] - expected.joints[j]).Stacked();
    for (int i = 0; i < 6; ++i) {
      if (result.certainty[j][i] != Certainty::kCertain) continue;
      EXPECT_NEAR(difference[i], 0, kPrecision * scale) << j << ' ' << i;
      ++certain;
    }
  }
  EXPECT_GT(certain, 0);
}

TEST_P(EveryHeldExample, PowerOfTheHandIsTheRateOfTheEnergy) {
  HandDynamics dynamics(held_.tree, held_.frame, K_, held_.q);
  const HandSample hand = Motion().At(0);
  dynamics.SetPose(held_.q);
  ASSERT_TRUE(dynamics.Evaluate(hand.V_WH, hand.A_WH));
  const VectorXd v = dynamics.v(), vdot = dynamics.vdot();
  Matrix6Xd J(6, held_.tree.nv);
  GraspJacobian(held_.tree, held_.ws, held_.frame.node, held_.frame.X_BG, &J);
  const double power = dynamics.w_d().dot(J * v);
  constexpr double kStep = 1e-4;  // a third of it leaves rounding, three times curvature
  const auto energy_at = [&](double t) {
    VectorXd q = held_.q;
    MoveCoordinates(held_.tree, t * v + 0.5 * t * t * vdot, &q);
    TreeWorkspace<double> ws(held_.tree);
    ForwardKinematics(held_.tree, q.data(), &ws);
    Matrix6Xd J_t(6, held_.tree.nv);
    GraspJacobian(held_.tree, ws, held_.frame.node, held_.frame.X_BG, &J_t);
    dynamics.SetPose(q);
    EXPECT_TRUE(dynamics.Evaluate(J_t * (v + t * vdot), Vector6d::Zero()));
    return dynamics.Energy();
  };
  const double rate = (energy_at(kStep) - energy_at(-kStep)) / (2 * kStep);
  EXPECT_NEAR(rate, power, 1e-5 * (1 + std::abs(power)));
}

TEST_P(EveryHeldExample, HandWrenchLiesAlongTheFreeMotion) {
  // w_d = K J N s, so that w_d / K is a twist which the mechanism allows.
  HandDynamics dynamics(held_.tree, held_.frame, K_, held_.q);
  dynamics.SetPose(held_.q);
  ASSERT_TRUE(dynamics.Evaluate(Vector6d::Zero(), Vector6d::Zero()));
  const Vector6d yielding = dynamics.w_d().cwiseQuotient(K_);
  Matrix6Xd J(6, held_.tree.nv);
  GraspJacobian(held_.tree, held_.ws, held_.frame.node, held_.frame.X_BG, &J);
  dynamics.SetPose(held_.q);
  ASSERT_TRUE(dynamics.Evaluate(yielding, Vector6d::Zero()));
  EXPECT_LT((J * dynamics.v() - yielding).norm(), 1e-7 * yielding.norm());
}

/// A hand that is well beside the path, and moves.
struct BesideThePath {
  BesideThePath(const Held& held, const Vector6d& K)
      : options(InTheMetric(K)), tracker(held.tree, held.frame, held.q, options) {
    way << 0.01, -0.015, 0.012, 0.05, 0.08, -0.04;
    X_WH = Displaced(held.X_WG, way);
  }
  static TrackOptions InTheMetric(const Vector6d& K) {
    TrackOptions options;
    options.kinematics.stiffness = K;
    options.step_tolerance = 1e-12;
    options.steps = 20;
    return options;
  }
  VectorXd PoseAt(const Posed& X) {
    for (int i = 0; i < 5; ++i) static_cast<void>(tracker.Advance(X));
    return tracker.q();
  }

  TrackOptions options;
  HandTracker tracker;
  Vector6d way;
  Posed X_WH;
};

TEST_P(EveryHeldExample, VelocityIsThatOfTheNearestPose) {
  BesideThePath hand(held_, K_);
  Vector6d V;
  V << 0.3, 0.2, -0.4, 0.5, -0.3, 0.6;
  constexpr double kStep = 1e-4;
  const VectorXd after = hand.PoseAt(Displaced(hand.X_WH, kStep * V));
  const VectorXd before = hand.PoseAt(Displaced(hand.X_WH, -kStep * V));
  const VectorXd q = hand.PoseAt(hand.X_WH);
  VectorXd expected = VectorXd::Zero(held_.tree.nv);
  CoordinateDifference(held_.tree, before, after, &expected);
  expected /= 2 * kStep;
  MatrixXd S = MatrixXd::Zero(held_.tree.nv, held_.tree.nv);
  hand.tracker.ComputeCurvature(&S);
  HandDynamics dynamics(held_.tree, held_.frame, K_, held_.q);
  dynamics.SetPose(q);
  const Vector3d turn = HandError(dynamics.SetPose(q), hand.X_WH).tail<3>();
  ASSERT_TRUE(dynamics.FindVelocities(V, &S, turn));
  // To first order of the rotation that is left, 0.1 rad.
  EXPECT_LT((dynamics.v() - expected).norm(), 0.01 * expected.norm());
}

TEST_P(EveryHeldExample, HandBesideThePathGivesWhatTheMechanismGets) {
  BesideThePath hand(held_, K_);
  const VectorXd q = hand.PoseAt(hand.X_WH);
  MatrixXd S = MatrixXd::Zero(held_.tree.nv, held_.tree.nv);
  hand.tracker.ComputeCurvature(&S);
  HandDynamics dynamics(held_.tree, held_.frame, K_, held_.q);
  dynamics.SetPose(q);
  const Vector6d V = Vector6d::Constant(0.3);
  const Vector3d turn = HandError(dynamics.SetPose(q), hand.X_WH).tail<3>();
  ASSERT_TRUE(dynamics.FindVelocities(V, &S, turn));
  const VectorXd v = dynamics.v(), still = VectorXd::Zero(held_.tree.nv);
  ASSERT_TRUE(dynamics.Evaluate(v, still, still));
  const double power = dynamics.w_d().dot(V);
  // The rate at which the weight rises.
  const auto height = [&](double t) {
    VectorXd there = q;
    MoveCoordinates(held_.tree, t * v, &there);
    dynamics.SetPose(there);
    EXPECT_TRUE(dynamics.Evaluate(still, still, still));
    return dynamics.Energy();
  };
  constexpr double kStep = 1e-4;
  const double rate = (height(kStep) - height(-kStep)) / (2 * kStep);
  EXPECT_NEAR(power, rate, 1e-5 * (1 + std::abs(power)));
}

TEST_P(EveryHeldExample, InertiaRatioIsTheLargestThatTheHandleMeets) {
  HandDynamics dynamics(held_.tree, held_.frame, K_, held_.q);
  dynamics.SetPose(held_.q);
  Vector6d D;
  D << 0.8, 0.8, 0.8, 0.005, 0.005, 0.005;
  Matrix6d accelerated;  // what the hand exerts for each unit acceleration from rest, less weight
  ASSERT_TRUE(dynamics.Evaluate(Vector6d::Zero(), Vector6d::Zero()));
  const Vector6d weight = dynamics.w_d();
  for (int i = 0; i < 6; ++i) {
    ASSERT_TRUE(dynamics.Evaluate(Vector6d::Zero(), Vector6d::Unit(i)));
    accelerated.col(i) = dynamics.w_d() - weight;
  }
  const Vector6d root = D.cwiseSqrt().cwiseInverse();
  const Matrix6d normal = root.asDiagonal() * accelerated * root.asDiagonal();
  const double largest = Eigen::SelfAdjointEigenSolver<Matrix6d>(normal).eigenvalues()[5];
  ASSERT_TRUE(dynamics.FindVelocities(Vector6d::Zero(), nullptr));
  double ratio = 0;
  for (int i = 0; i < 60; ++i) ratio = dynamics.InertiaRatio(D);
  EXPECT_NEAR(ratio / largest, 1, 1e-3);
}

TEST_P(EveryHeldExample, PapersWrenchIsThatOfTheLoadStudyByEquation14) {
  const HandLaw law = Motion();
  LoadStudy study;
  study.mechanism = held_.tree.mechanism;
  study.hand = HandDrive{held_.index, law, K_};
  study.times = {0};
  study.rule = ReactionRule::kPaperJoint;
  const auto expected = RunLoadStudy(study).poses[0];
  HandDynamics dynamics(held_.tree, held_.frame, K_, held_.q, WrenchRule::kPaper);
  const HandSample hand = law.At(0);
  dynamics.SetPose(held_.q);
  ASSERT_TRUE(dynamics.Evaluate(hand.V_WH, hand.A_WH));
  const double scale = 1 + expected.hand.Stacked().norm();
  EXPECT_LT((dynamics.w_d() - expected.hand.Stacked()).norm(), 1e-5 * scale);
  for (size_t j = 0; j < dynamics.joints().size(); ++j) {
    EXPECT_LT((dynamics.joints()[j] - expected.joints[j]).Stacked().norm(), 1e-5 * scale) << j;
  }
}

INSTANTIATE_TEST_SUITE_P(Examples, EveryHeldExample,
                         testing::Values("crank", "two-link-arm", "slider-crank", "four-bar",
                                         "rssr", "bennett", "spherical-four-bar", "stewart-gough",
                                         "delta-robot", "marghitu-slider-crank"),
                         [](const auto& info) { return TestName(info.param); });

TEST(HandDynamics, ShareOfInertiaLeavesTheWeightWhole) {
  const Held held(Example("four-bar"), "handle");
  HandDynamics dynamics(held.tree, held.frame, Vector6d::Ones(), held.q);
  dynamics.SetPose(held.q);
  const auto wrench = [&](const Vector6d& V, const Vector6d& A, double inertia) -> Vector6d {
    EXPECT_TRUE(dynamics.Evaluate(V, A, inertia));
    return dynamics.w_d();
  };
  const Vector6d V = Vector6d::Constant(0.7), A = Vector6d::Constant(-2), zero = Vector6d::Zero();
  const Vector6d weight = wrench(zero, zero, 1), whole = wrench(V, A, 1);
  EXPECT_GT((whole - weight).norm(), 1);
  EXPECT_LT((wrench(V, A, 0.3) - weight - 0.3 * (whole - weight)).norm(), 1e-6);
}

TEST(HandDynamics, RefusesAGraspThatLeavesALinkLoose) {
  Mechanism arm = Example("two-link-arm");
  arm.grasps[FindGrasp(arm, "handle")].link = FindLink(arm, "upper-arm");
  const Held held(arm, "handle");
  try {
    HandDynamics(held.tree, held.frame, Vector6d::Ones(), held.q);
    FAIL() << "accepted";
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find("does not move 'elbow'"), std::string::npos)
        << error.what();
  }
}

TEST(HandDynamics, SpringsAndDampersPushBack) {
  Mechanism crank = Example("crank");
  crank.joints[0].passive[0] = {.stiffness = 7, .rest = 0.1, .viscous = 0.5};
  const Held with(crank, "tip"), without(Example("crank"), "tip");
  HandDynamics stiff(with.tree, with.frame, Vector6d::Ones(), with.q);
  HandDynamics free(without.tree, without.frame, Vector6d::Ones(), without.q);
  const double angle = 40 * std::numbers::pi / 180;
  Vector6d V;
  V << 0.3 * 3 * Vector3d(-std::sin(angle), std::cos(angle), 0), 0, 0, 3;
  stiff.SetPose(with.q);
  ASSERT_TRUE(stiff.Evaluate(V, Vector6d::Zero()));
  free.SetPose(without.q);
  ASSERT_TRUE(free.Evaluate(V, Vector6d::Zero()));
  const double torque = 7 * (angle - 0.1) + 0.5 * 3;
  EXPECT_NEAR((stiff.w_d() - free.w_d()).norm() * 0.3, torque, 1e-9);
}

}  // namespace
}  // namespace vmech
