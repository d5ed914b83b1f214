#include "vmech/hw_interface/rendering/coupled_tick.h"

#include <gtest/gtest.h>

#include <complex>
#include <numbers>

#include "hw_interface/free_motion.h"
#include "hw_interface/tick_input.h"
#include "support/examples.h"
#include "vmech/base/linear_algebra/linear_algebra.h"
#include "vmech/base/rotation_error.h"
#include "vmech/dynamics/in_hand/hand_dynamics.h"
#include "vmech/dynamics/rigid_body/newton_euler.h"
#include "vmech/hw_interface/loop/runner.h"
#include "vmech/hw_interface/masters/simulated_master.h"
#include "vmech/hw_interface/rendering/coupling_choice.h"
#include "vmech/kinematics/loops/loops.h"
#include "vmech/kinematics/tree/forward_kinematics.h"

namespace vmech::coupled_tick_test {
namespace {

constexpr double kPeriod = 1e-3;
constexpr double kSmoothing = 2e-3;

Posed HandleStart() {
  return ArmModel(std::make_shared<const ArmDescription>(SarcosMasterArm())).X_DH();
}

/// A mechanism on the coupling that suits a simulated arm; the whole session can run.
struct Session {
  Session(const Mechanism& mechanism, const std::string& grasp_name,
          const SimulatedMasterOptions& arm)
      : tree(BuildKinematicTree(mechanism)), q(ClosedStart(tree)), master(arm) {
    master.Configure();
    grasp = FindGrasp(mechanism, grasp_name);
    choice = ChooseCoupling(tree, GraspFrameOf(tree, grasp), q, master.info(), kSmoothing);
    CoupledTickOptions options;
    options.coupling = choice.coupling;
    options.scale = choice.scale;
    tick = std::make_unique<CoupledTick>(tree, grasp, q, kPeriod, options);
  }

  RunSummary Run(double seconds) {
    RunnerOptions options;
    options.seconds = seconds;
    options.record = true;
    options.realtime.reset();
    options.safety = choice.Safety();
    FreeRunningClock clock;
    Runner runner(options, &master, tick.get(), &clock);
    const RunSummary summary = runner.Run();
    kept = runner.Kept();
    return summary;
  }
  TickOutput Step(const Posed& X_WH) {
    std::vector<double> channels(tick->ChannelNames().size());
    return tick->Step(FreshInput(X_WH, kPeriod), channels);
  }
  Vector6d Rest(const Posed& X_WH) {
    for (int k = 0; k < 5000; ++k) EXPECT_EQ(Step(X_WH).status, TickStatus::kOk);
    return Step(X_WH).F_Ho_W;
  }

  KinematicTree tree;
  VectorXd q;
  SimulatedMaster master;
  int grasp = -1;
  CouplingChoice choice;
  std::unique_ptr<CoupledTick> tick;
  Recording kept;
};

TEST(CoupledTick, HandPulledOffIsPulledBack) {
  Mechanism crank = Example("crank");
  crank.gravity_W.setZero();
  Session held(crank, "tip", {});
  Posed X_WH = held.tick->GraspFrame();
  const Vector3d outwards = X_WH.p.normalized();
  X_WH.p += 0.01 * outwards;
  const Vector6d F = held.Rest(X_WH);
  const double pull = 0.01 * held.choice.coupling.stiffness[0];
  EXPECT_LT((F.head<3>() + pull * outwards).norm(), 1e-6 * pull);
  EXPECT_EQ(F.tail<3>().norm(), 0);  // a point grasp
}

TEST(CoupledTick, TakesHoldWithoutAJumpAndLetsGoOfItsSpeed) {
  Session held(Example("crank"), "tip", {});
  EXPECT_LT(held.Step(held.tick->GraspFrame()).F_Ho_W.norm(), 1);
  Posed X_WH = held.tick->GraspFrame();
  for (int k = 0; k < 100; ++k) {
    X_WH.p.x() -= 1e-3;
    ASSERT_EQ(held.Step(X_WH).status, TickStatus::kOk);
  }
  EXPECT_GT(held.tick->dynamics().v().norm(), 0.1);
  held.tick->Reset();
  EXPECT_EQ(held.tick->dynamics().v().norm(), 0);
  EXPECT_LT(held.Step(held.tick->GraspFrame()).F_Ho_W.norm(), 1);
}

TEST(CoupledTick, TakesHoldOfTheNearestLinkWhereTheHandIs) {
  Mechanism four_bar = Example("four-bar");
  four_bar.gravity_W.setZero();
  Session held(four_bar, "handle", {});
  for (const char* name : {"crank", "rocker", "coupler"}) {
    // A centimetre beside the middle of the link.
    const int link = FindLink(four_bar, name);
    const int node = held.tree.NodeOfLink(link);
    const std::vector<Anchor>& anchors = four_bar.links[link].anchors;
    const Posed X_WL = held.tick->dynamics().pose().X_WB(node) * held.tree.X_node_link(link);
    Posed X_WH = X_WL;
    X_WH.p = X_WL * (0.5 * (anchors[0].X_LA.p + anchors[1].X_LA.p)) + Vector3d(0, 0, 0.01);
    ASSERT_TRUE(held.tick->GraspAt(X_WH));
    EXPECT_EQ(held.tick->dynamics().pose().grasp().node, node) << name;
    EXPECT_LT((held.tick->GraspFrame().p - X_WH.p).norm(), 1e-12);
    EXPECT_LT(held.Step(X_WH).F_Ho_W.norm(), 1e-9);
  }
}

TEST(CoupledTick, HandThatLetsGoFeelsTheWrenchFadeAndTheMechanismMovesOn) {
  Session held(Example("crank"), "tip", {});
  const Posed X_WH = held.tick->GraspFrame();
  double last = held.Rest(X_WH).norm();
  EXPECT_GT(last, 1);
  std::vector<double> channels(held.tick->ChannelNames().size());
  TickInput input;
  input.X_WH = X_WH;
  input.held = false;
  for (int k = 0; k < 200; ++k) {
    const double felt = held.tick->Step(input, channels).F_Ho_W.norm();
    EXPECT_LT(felt, last);
    EXPECT_GT(felt, 0.9 * last);
    last = felt;
  }
  EXPECT_LT(last, 1e-3);
  EXPECT_GT((held.tick->GraspFrame().p - X_WH.p).norm(), 0.05);  // it has fallen
}

TEST(Runner, GripperTakesHoldAndLetsGoWithoutAJump) {
  // Swinging alone gives up to 10 N a tick; taking hold of a swinging link at once gave 130 N.
  constexpr double kJump = 20;
  for (const char* name : {"crank", "four-bar"}) {
    SimulatedMasterOptions arm;
    arm.squeeze = [](double t) { return std::fmod(t, 2.0) < 1 ? -0.4 : 0.4; };
    Session session(Example(name), "handle", arm);
    RunnerOptions options;
    options.seconds = 8;
    options.record = true;
    options.gripper = true;
    options.realtime.reset();
    options.safety = session.choice.Safety();
    FreeRunningClock clock;
    Runner runner(options, &session.master, session.tick.get(), &clock);
    const RunSummary summary = runner.Run();
    EXPECT_EQ(summary.status, RunStatus::kFinished) << name << summary.FullReport();
    EXPECT_EQ(summary.grasps, 4u);
    Vector3d before = Vector3d::Zero();
    for (const TickRecord& record : runner.Kept().ticks) {
      const Vector3d force = record.sent_F_Ho_D.head<3>();
      ASSERT_LT((force - before).norm(), kJump) << name;
      before = force;
    }
  }
}

class EveryCoupledSession : public testing::TestWithParam<std::string> {};

TEST_P(EveryCoupledSession, RunsWithoutAFault) {
  SimulatedMasterOptions arm;
  arm.motion = Wander(HandleStart(), 0.04, 0.15, 2);
  Session session(Example(GetParam()), "handle", arm);
  const RunSummary summary = session.Run(5);
  EXPECT_EQ(summary.status, RunStatus::kFinished) << summary.FullReport();
  EXPECT_GT(summary.least_energy, -0.02);
  EXPECT_LT(session.tick->summary().worst_closure, 1e-10);
  EXPECT_EQ(session.tick->summary().stopped, 0);
}

/// What the device shows of a mechanism without weight when an operator shakes it along a free
/// motion: the part of the felt force that goes with the acceleration, over the true inertia.
std::complex<double> FeltOverTrueInertia(const std::string& name, double hertz) {
  Mechanism mechanism = Example(name);
  mechanism.gravity_W.setZero();
  const KinematicTree tree = BuildKinematicTree(mechanism);
  const VectorXd q = ClosedStart(tree);
  const GraspFrame grasp = GraspFrameOf(tree, FindGrasp(mechanism, "handle"));
  GraspedMechanism pose(tree, grasp);
  pose.Set(q);
  constexpr double kRank = 1e-9;
  const MatrixXd N = tree.loops.empty() ? MatrixXd(MatrixXd::Identity(tree.nv, tree.nv))
                                        : FindNullSpace(pose.C(), kRank).basis;
  const MatrixXd JN = pose.J() * N, M = N.transpose() * MassMatrix(tree, q) * N;

  constexpr double kReach = 1e-3;  // [m]: the inertia changes along the way
  const Vector6d way =
      kReach * JN.col(0) / (JN.col(0).head<3>().norm() + 0.1 * JN.col(0).tail<3>().norm());
  SimulatedMasterOptions arm;
  arm.hand = ImpedanceOf(Grip::kFirm);
  const Posed X_DH = HandleStart();
  const double rate = 2 * std::numbers::pi * hertz;
  arm.motion = [=](double t) {
    const Vector6d s = std::sin(rate * t) * way;
    const double angle = s.tail<3>().norm();
    HandTargetMotion target{X_DH, rate * std::cos(rate * t) * way};
    target.X_DT.p += s.head<3>();
    if (angle > 0) {
      target.X_DT.R = Eigen::AngleAxisd(angle, s.tail<3>() / angle).toRotationMatrix() * X_DH.R;
    }
    return target;
  };
  Session session(mechanism, "handle", arm);
  EXPECT_EQ(session.Run(6).status, RunStatus::kFinished);

  // Fourier components at that rate over whole seconds.
  Vector6<std::complex<double>> X = Vector6<std::complex<double>>::Zero(), F = X;
  for (int k = 2000; k < 6000; ++k) {
    const TickRecord& record = session.kept.ticks[k];
    const std::complex<double> phase = std::polar(1.0, -rate * k * kPeriod);
    X += phase * HandError(X_DH, record.state.X_DH).cast<std::complex<double>>();
    F += phase * record.sent_F_Ho_D.cast<std::complex<double>>();
  }
  // The free motion nearest to the hand's, in the metric of the coupling.
  const MatrixXd KJN = session.choice.coupling.stiffness.asDiagonal() * JN;
  const Eigen::VectorXcd s = (KJN.transpose() * JN)
                                 .eval()
                                 .cast<std::complex<double>>()
                                 .lu()
                                 .solve(KJN.transpose().cast<std::complex<double>>() * X);
  const Eigen::VectorXcd expected =
      rate * rate * session.choice.scale * (M.cast<std::complex<double>>() * s);
  const Eigen::VectorXcd felt = JN.transpose().cast<std::complex<double>>() * F;
  return expected.dot(felt) / expected.squaredNorm();
}

TEST_P(EveryCoupledSession, FeltInertiaIsTheTrueOneBelow3Hertz) {
  for (const double hertz : {1.0, 2.0, 2.75}) {
    EXPECT_NEAR(FeltOverTrueInertia(GetParam(), hertz).real(), 1, 0.05) << hertz;
  }
}

INSTANTIATE_TEST_SUITE_P(Examples, EveryCoupledSession,
                         testing::Values("crank", "two-link-arm", "slider-crank", "four-bar",
                                         "rssr", "bennett", "stewart-gough"),
                         [](const auto& info) { return TestName(info.param); });

TEST(ChooseCoupling, ScalesDownWhatIsTooHeavyForTheDevice) {
  const Mechanism platform = Example("stewart-gough");
  const KinematicTree tree = BuildKinematicTree(platform);
  const GraspFrame grasp = GraspFrameOf(tree, FindGrasp(platform, "handle"));
  DeviceInfo device;
  device.takes_wrench = true;
  device.linear = {10, 1, 0, 0, 100, 2};
  device.angular = {1, 1, 0, 0, 10, 15};
  const VectorXd q = ClosedStart(tree);
  const CouplingChoice choice = ChooseCoupling(tree, grasp, q, device, kSmoothing);
  // The platform's 10 kg and its legs' share.
  EXPECT_GT(choice.weight, 10 * 9.81);
  EXPECT_NEAR(choice.scale * choice.weight, 50, 1e-9);
  device.linear.peak = 0;
  EXPECT_EQ(ChooseCoupling(tree, grasp, q, device, kSmoothing).scale, 1);
}

TEST(ChooseCoupling, RefusesAStructure) {
  const KinematicTree tree = BuildKinematicTree(Example("beam-on-three-supports"));
  EXPECT_THROW(ChooseCoupling(tree, GraspFrameOf(tree, 0), ClosedStart(tree), {}, kSmoothing),
               std::invalid_argument);
}

TEST(ChooseCoupling, SlowerDevicesGetASofterSpring) {
  const Mechanism four_bar = Example("four-bar");
  const KinematicTree tree = BuildKinematicTree(four_bar);
  const GraspFrame grasp = GraspFrameOf(tree, 0);
  SimulatedMaster master;
  master.Configure();
  DeviceInfo device = master.info();
  const CouplingChoice fast = ChooseCoupling(tree, grasp, ClosedStart(tree), device, kSmoothing);
  device.delay = 0.01;
  const CouplingChoice slow = ChooseCoupling(tree, grasp, ClosedStart(tree), device, kSmoothing);
  EXPECT_EQ(fast.scale, 1);
  EXPECT_LT(slow.scale, 0.2);
  EXPECT_LT(slow.coupling.stiffness[0], 0.2 * fast.coupling.stiffness[0]);
}

}  // namespace
}  // namespace vmech::coupled_tick_test
