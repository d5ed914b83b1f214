/// The paper's way of rendering in whole sessions: simulated arm, operator, filter, loop.
///
/// VMECH_PAPER_SECONDS sets how long the sessions of every grip last; 60 takes a minute or two.

#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <cstdlib>
#include <numbers>

#include "hw_interface/free_motion.h"
#include "hw_interface/tick_input.h"
#include "support/examples.h"
#include "vmech/base/rotation_error.h"
#include "vmech/dynamics/in_hand/passive_joints.h"
#include "vmech/hw_interface/loop/runner.h"
#include "vmech/hw_interface/masters/simulated_master.h"
#include "vmech/hw_interface/rendering/coupling_choice.h"
#include "vmech/hw_interface/rendering/hand_motion.h"
#include "vmech/hw_interface/rendering/paper_choice.h"
#include "vmech/kinematics/loops/assembled_mechanism.h"
#include "vmech/kinematics/tree/forward_kinematics.h"

namespace vmech::paper_way_test {
namespace {

double Seconds() {
  const char* text = std::getenv("VMECH_PAPER_SECONDS");
  return text ? std::atof(text) : 2;
}

/// A mechanism at its first grasp, in the hand of an operator at a simulated arm whose axes are
/// those of the world.
struct Session {
  Session(const Mechanism& mechanism, Grip grip, const PaperRequest& request = {})
      : tree(BuildKinematicTree(AssembleMechanism(mechanism).mechanism,
                                KeepPassiveJoints(mechanism))),
        q(StartCoordinates(tree)),
        frame(GraspFrameOf(tree, 0)) {
    arm.hand = ImpedanceOf(grip);
    X_DH = ArmModel(std::make_shared<const ArmDescription>(SarcosMasterArm())).X_DH();
    SimulatedMaster device(arm);
    device.Configure();
    info = device.info();
    choice = ChoosePaper(request, tree, 0, q, info);
    GraspedMechanism pose(tree, frame);
    pose.Set(q);
    registration = GraspedAt(Matrix3d::Identity(), X_DH, pose.X_WG());
  }

  RunSummary Run(const HandMotion& motion, double seconds) {
    arm.motion = motion;
    SimulatedMaster master(arm);
    master.Configure();
    MechanismTick tick(tree, 0, q, info, choice.tick);
    RunnerOptions options;
    options.seconds = seconds;
    options.record = true;
    options.realtime.reset();
    options.safety = choice.safety;
    options.observer = choice.observer;
    FreeRunningClock clock;
    Runner runner(options, &master, &tick, &clock);
    const RunSummary summary = runner.Run();
    recording = runner.Kept();
    share = tick.share();
    return summary;
  }
  RunSummary Wandering(double seconds) { return Run(Wander(X_DH, 0.05, 0.2, 1), seconds); }

  Vector3d Force(size_t k) const { return recording.ticks[k].sent_F_Ho_D.head<3>(); }
  Vector3d Position(size_t k) const { return recording.ticks[k].state.X_DH.p; }

  KinematicTree tree;
  VectorXd q;
  GraspFrame frame;
  SimulatedMasterOptions arm;
  Posed X_DH;
  DeviceInfo info;
  PaperChoice choice;
  Registration registration;
  Recording recording;
  double share = 0;
};

Mechanism WithoutWeight(const std::string& example) {
  Mechanism mechanism = Example(example);
  mechanism.gravity_W.setZero();
  return mechanism;
}

/// Those that can be held.
std::vector<std::string> Examples() {
  std::vector<std::string> names = ExampleNames();
  names.insert(names.end(), {"puma-560", "redundant-arm", "stewart-gough-sps"});
  std::erase_if(names, [](const std::string& name) { return Example(name).grasps.empty(); });
  return names;
}

class EveryExampleAndGrip : public testing::TestWithParam<std::tuple<std::string, Grip>> {};

TEST_P(EveryExampleAndGrip, RunsOrIsRefused) {
  const auto& [name, grip] = GetParam();
  const Mechanism mechanism = Example(name);
  const bool refusable = name == "redundant-arm" || name == "beam-on-three-supports";
  if (refusable) {  // a link stays loose, or nothing moves
    EXPECT_THROW(Session(mechanism, grip), std::invalid_argument);
    return;
  }
  const auto session = std::make_unique<Session>(mechanism, grip);
  const RunSummary summary = session->Wandering(Seconds());
  EXPECT_EQ(summary.status, RunStatus::kFinished) << summary.FullReport();
  EXPECT_LE(summary.peak_force, session->info.linear.peak * (1 + 1e-9));
}

std::string NameOfCase(const testing::TestParamInfo<std::tuple<std::string, Grip>>& info) {
  const std::vector<std::string> grips{"Absent", "Light", "Relaxed", "Firm"};
  return TestName(std::get<0>(info.param)) + grips[static_cast<size_t>(std::get<1>(info.param))];
}

INSTANTIATE_TEST_SUITE_P(, EveryExampleAndGrip,
                         testing::Combine(testing::ValuesIn(Examples()),
                                          testing::Values(Grip::kAbsent, Grip::kLight,
                                                          Grip::kRelaxed, Grip::kFirm)),
                         NameOfCase);

class PapersExample : public testing::TestWithParam<std::string> {};

TEST_P(PapersExample, IsNotRefused) {
  EXPECT_NO_THROW(Session(Example(GetParam()), Grip::kRelaxed));
}

TEST_P(PapersExample, HandAtRestFeelsRest) {
  Session session(Example(GetParam()), Grip::kFirm);
  ASSERT_EQ(session.Run(HoldAt(session.X_DH), 4).status, RunStatus::kFinished);
  Vector3d mean = Vector3d::Zero();
  double squares = 0;
  constexpr size_t kFrom = 3000, kTo = 4000;
  for (size_t k = kFrom; k < kTo; ++k) mean += session.Force(k) / (kTo - kFrom);
  for (size_t k = kFrom; k < kTo; ++k) squares += (session.Force(k) - mean).squaredNorm();
  EXPECT_GT(mean.norm(), 0.5);  // the weight is there
  EXPECT_LT(std::sqrt(squares / (kTo - kFrom)), 0.1);
}

/// Across the plane of the mechanism, where nothing but the constraint acts.
TEST_P(PapersExample, StiffnessFeltIsThePrintedOne) {
  Session session(Example(GetParam()), Grip::kFirm);
  const Vector3d z = Vector3d::UnitZ();
  Posed away = session.X_DH;
  away.p += 0.02 * z;
  ASSERT_EQ(session.Run(ReachTo(session.X_DH, away, 0.6, 1), 4).status, RunStatus::kFinished);
  double force = 0, offset = 0;
  for (size_t k = 3500; k < 4000; ++k) {
    force -= z.dot(session.Force(k));
    offset += z.dot(session.Position(k) - session.X_DH.p);
  }
  EXPECT_GT(offset / 500, 2e-3);
  EXPECT_NEAR(force / offset, session.choice.tick.law.stiffness[2],
              0.01 * session.choice.tick.law.stiffness[2]);
}

INSTANTIATE_TEST_SUITE_P(, PapersExample,
                         testing::Values("crank", "two-link-arm", "slider-crank", "four-bar"),
                         [](const auto& info) { return TestName(info.param); });

class OneFreedom : public testing::TestWithParam<std::string> {};

/// A hand that hardly yields goes to and fro along the free motion, 10 mm to both sides at 3 Hz:
/// the force of that frequency against the motion, of the share that is to be felt.
TEST_P(OneFreedom, FeltInertiaIsTheTrueOneAt3Hertz) {
  constexpr double kStroke = 0.01, kFivePercent = 0.05, kDegrees = 15;
  constexpr double kRate = 2 * std::numbers::pi * 3;
  Session session(WithoutWeight(GetParam()), Grip::kFirm);
  session.arm.hand = {0.554, 3e4, 300, 75, 0.75};
  const FreeMotion motion(session.tree, session.frame, session.q, 0.015);
  const HandMotion swing = [&](double t) {
    const HandSample hand = motion.At(kStroke * std::sin(kRate * t));
    const Registration& at = session.registration;
    HandTargetMotion target{at.X_WD.inverse() * hand.X_WH,
                            kStroke * kRate * std::cos(kRate * t) * hand.V_WH};
    target.X_DT.R *= at.R_HK.transpose();
    return target;
  };
  ASSERT_EQ(session.Run(swing, 4).status, RunStatus::kFinished);
  std::complex<double> force = 0, expected = 0, target = 0, moved = 0;
  for (size_t k = 2000; k < 4000; ++k) {  // whole periods
    const TickRecord& tick = session.recording.ticks[k];
    const double turn = kRate * 1e-3 * static_cast<double>(k), s = kStroke * std::sin(turn);
    const std::complex<double> phase = std::polar(1.0, -turn);
    const HandSample hand = motion.At(s);
    const Vector6d beside = HandError(hand.X_WH, session.registration.HandInWorld(tick.state.X_DH));
    const Vector6d pull = session.choice.tick.law.stiffness.cwiseProduct(hand.V_WH);
    force -= phase * tick.sent_F_Ho_D.dot(hand.V_WH);
    expected += phase * tick.channels[4] *
                motion.InertiaForce(s, kStroke * kRate * std::cos(turn), -kRate * kRate * s);
    target += phase * s;
    moved += phase * (s + pull.dot(beside) / pull.dot(hand.V_WH));  // of the nearest pose
  }
  const std::complex<double> felt = force / expected * (target / moved);
  RecordProperty("felt", std::to_string(felt.real()));
  RecordProperty("degrees", std::to_string(std::arg(felt) * 180 / std::numbers::pi));
  EXPECT_NEAR(felt.real(), 1, kFivePercent);
  EXPECT_LT(std::abs(std::arg(felt)) * 180 / std::numbers::pi, kDegrees);
}

INSTANTIATE_TEST_SUITE_P(, OneFreedom, testing::Values("crank", "slider-crank", "four-bar"),
                         [](const auto& info) { return TestName(info.param); });

TEST(PaperWay, RendersMoreThanOneAndAHalfTimesTheHandlesMass) {
  const Session session(Example("four-bar"), Grip::kFirm);
  EXPECT_GT(session.choice.inertia_ratio, 3);
  EXPECT_GE(session.choice.tick.inertia_ratio, 1.5);
}

TEST(PaperWay, ScaleIsThatOfAllTheMechanismExerts) {
  Session whole(Example("four-bar"), Grip::kFirm, {.scale = 1});
  Session tenth(Example("four-bar"), Grip::kFirm, {.scale = 0.1});
  whole.Run(HoldAt(whole.X_DH), 4);
  tenth.Run(HoldAt(tenth.X_DH), 4);
  EXPECT_NEAR(tenth.Force(3999).norm() / whole.Force(3999).norm(), 0.1, 2e-3);
}

class EveryChoice : public testing::TestWithParam<PaperRequest> {};

TEST_P(EveryChoice, RunsTheFourBar) {
  Session session(Example("four-bar"), Grip::kRelaxed, GetParam());
  const RunSummary summary = session.Wandering(3);
  EXPECT_EQ(summary.status, RunStatus::kFinished) << summary.FullReport();
}

INSTANTIATE_TEST_SUITE_P(
    , EveryChoice,
    testing::Values(PaperRequest{.contact = ContactKind::kViscoelastic},
                    PaperRequest{.contact = ContactKind::kHuntCrossley},
                    PaperRequest{.estimator = EstimatorKind::kKalman},
                    PaperRequest{.estimator = EstimatorKind::kQuadraticFit},
                    PaperRequest{.estimator = EstimatorKind::kAdaptiveWindow},
                    PaperRequest{.estimator = EstimatorKind::kFiniteDifferences},
                    PaperRequest{.wrench = WrenchRule::kPaper}, PaperRequest{.scale = 0.3},
                    PaperRequest{.stiffness = 300}));

}  // namespace
}  // namespace vmech::paper_way_test
