/// Dead centres, joint limits and the edge of the workspace, with an operator who does not care.

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "hw_interface/tick_input.h"
#include "support/examples.h"
#include "vmech/hw_interface/loop/runner.h"
#include "vmech/hw_interface/masters/simulated_master.h"
#include "vmech/hw_interface/rendering/coupled_tick.h"
#include "vmech/hw_interface/rendering/coupling_choice.h"
#include "vmech/hw_interface/rendering/mechanism_tick.h"

namespace vmech::hard_places_test {
namespace {

constexpr double kPeriod = 1e-3;
/// Farther than any joint moves in a tick of these sessions, nearer than the other branch [rad].
constexpr double kJump = 0.15;

/// Watches the pose of a tick for jumps. Allocates no more than the tick does.
template <typename Inner>
class Watched : public Tick {
 public:
  Watched(Inner* inner, const VectorXd& q) : inner_(inner), q_(q), last_(q) {}
  std::vector<std::string> ChannelNames() const override { return inner_->ChannelNames(); }
  Posed GraspFrame() const noexcept override { return inner_->GraspFrame(); }
  void Reset() noexcept override { inner_->Reset(); }
  TickOutput Step(const TickInput& input, std::span<double> channels) noexcept override {
    const TickOutput out = inner_->Step(input, channels);
    farthest = std::max(farthest, (q_ - last_).cwiseAbs().maxCoeff());
    last_ = q_;
    return out;
  }
  double farthest = 0;

 private:
  Inner* inner_;
  const VectorXd& q_;
  VectorXd last_;
};

/// The slider-crank held by its piston.
Mechanism PistonInHand() {
  Mechanism mechanism = Example("slider-crank");
  mechanism.grasps = {{"piston", FindLink(mechanism, "slider"), {}, GraspKind::kPoint}};
  return mechanism;
}

/// The two-link arm with an elbow that may bend by a quarter of a radian either way.
Mechanism StiffElbow() {
  Mechanism mechanism = Example("two-link-arm");
  Joint& elbow = mechanism.joints[FindJoint(mechanism, "elbow")];
  elbow.lower = {elbow.start[0] - 0.25};
  elbow.upper = {elbow.start[0] + 0.25};
  return mechanism;
}

/// An operator with a firm grip swings the hand by `reach` along the device's axes.
struct Session {
  Session(const Mechanism& mechanism, const Vector3d& reach, double hertz = 0.5)
      : tree(BuildKinematicTree(mechanism)), q(StartCoordinates(tree)), master(Arm(reach, hertz)) {
    EXPECT_TRUE(Assemble(tree, {}, &q).closed);
    master.Configure();
    choice = ChooseCoupling(tree, GraspFrameOf(tree, 0), q, master.info(), 2 * kPeriod);
  }

  static SimulatedMasterOptions Arm(const Vector3d& reach, double hertz) {
    SimulatedMasterOptions options;
    options.hand = ImpedanceOf(Grip::kFirm);
    const Posed X_DH = ArmModel(std::make_shared<const ArmDescription>(SarcosMasterArm())).X_DH();
    options.motion = [=](double t) {
      const double rate = 2 * std::numbers::pi * hertz;
      HandTargetMotion target{X_DH, Vector6d::Zero()};
      target.X_DT.p += std::sin(rate * t) * reach;
      target.V_DT.head<3>() = rate * std::cos(rate * t) * reach;
      return target;
    };
    return options;
  }

  RunSummary Run(Tick* tick, const SafetyOptions& safety) {
    RunnerOptions options;
    options.seconds = 6;
    options.realtime.reset();
    options.safety = safety;
    options.record = true;
    FreeRunningClock clock;
    Runner runner(options, &master, tick, &clock);
    const RunSummary summary = runner.Run();
    ExpectNothingWithheld(runner.Kept());
    EXPECT_LE(summary.peak_force, master.info().linear.peak * (1 + 1e-9));
    return summary;
  }
  /// The arm exerted what it was sent.
  static void ExpectNothingWithheld(const Recording& recording) {
    for (size_t k = 1; k < recording.ticks.size(); ++k) {
      const Vector6d exerted = recording.ticks[k].state.applied_F_Ho_D;
      ASSERT_LT((exerted - recording.ticks[k - 1].sent_F_Ho_D).norm(), 1e-9) << k;
    }
  }
  CoupledTick Coupled() {
    CoupledTickOptions options;
    options.coupling = choice.coupling;
    options.scale = choice.scale;
    return CoupledTick(tree, 0, q, kPeriod, options);
  }

  KinematicTree tree;
  VectorXd q;
  SimulatedMaster master;
  CouplingChoice choice;
};

TEST(HardPlaces, PistonIsDraggedBeyondBothDeadCentresWithoutAJump) {
  Session session(PistonInHand(), Vector3d(0.12, 0, 0));
  CoupledTick tick = session.Coupled();
  Watched watched(&tick, tick.dynamics().q());
  const RunSummary summary = session.Run(&watched, session.choice.Safety());
  EXPECT_EQ(summary.status, RunStatus::kFinished) << summary.FullReport();
  EXPECT_LT(watched.farthest, kJump);
  EXPECT_LT(tick.summary().worst_closure, 1e-10);
  EXPECT_GT(tick.summary().farthest, 1e-4);  // the hand was beyond the stroke
}

TEST(HardPlaces, ElbowStopsAtItsLimitAndSaysSo) {
  Session session(StiffElbow(), Vector3d(0.1, 0.1, 0));
  CoupledTick tick = session.Coupled();
  Watched watched(&tick, tick.dynamics().q());
  const RunSummary summary = session.Run(&watched, session.choice.Safety());
  EXPECT_EQ(summary.status, RunStatus::kFinished) << summary.FullReport();
  EXPECT_GT(tick.summary().at_limit, 10);
  EXPECT_LT(watched.farthest, kJump);
}

/// The mechanism is never pushed with more than the arm has for the hand beside its own weight.
TEST(HardPlaces, AFirmHandShakesTheFourBarAtTwoHertz) {
  const Mechanism mechanism = Example("four-bar");
  for (const Vector3d& reach : {Vector3d(0.05, 0, 0), Vector3d(0, 0.05, 0), Vector3d(0, 0, 0.05)}) {
    Session session(mechanism, reach, 2);
    CoupledTick tick = session.Coupled();
    const RunSummary summary = session.Run(&tick, session.choice.Safety());
    EXPECT_EQ(summary.status, RunStatus::kFinished) << reach.transpose() << summary.FullReport();
  }
}

/// At the dead centre the hand sees no inertia at all; beside it, nearly a wall.
TEST(HardPlaces, AHandAtADeadCentreGetsTheCouplingOfThePosesAbout) {
  Mechanism mechanism = PistonInHand();
  for (Joint& joint : mechanism.joints) {
    if (joint.type == JointType::kRevolute) joint.start = {0};
  }
  Session session(mechanism, Vector3d(0.03, 0.03, 0));
  const double beside = Session(PistonInHand(), Vector3d::Zero()).choice.coupling.stiffness[0];
  EXPECT_GE(session.choice.coupling.stiffness[0], beside);
  CoupledTick tick = session.Coupled();
  const RunSummary summary = session.Run(&tick, session.choice.Safety());
  EXPECT_EQ(summary.status, RunStatus::kFinished) << summary.FullReport();
}

/// Two heavy links below the one that is held swing as they like.
TEST(HardPlaces, LooseHeavyLinksDoNotTrip) {
  Mechanism mechanism = Example("redundant-arm");
  mechanism.grasps = {{"first", 1, Posed{}, GraspKind::kRigid}};
  Session session(mechanism, Vector3d(0.05, 0.05, 0), 1);
  CoupledTick tick = session.Coupled();
  const RunSummary summary = session.Run(&tick, session.choice.Safety());
  EXPECT_EQ(summary.status, RunStatus::kFinished) << summary.FullReport();
}

TEST(HardPlaces, HandBeyondTheReachIsPulledWithNoMoreThanTheDeviceCan) {
  Mechanism arm = Example("two-link-arm");
  arm.gravity_W.setZero();
  Session session(arm, Vector3d::Zero());
  CoupledTick tick = session.Coupled();
  std::vector<double> channels(tick.ChannelNames().size());
  TickInput input = FreshInput(tick.GraspFrame(), kPeriod);
  const Vector3d outwards = input.X_WH.p.normalized();
  Vector3d before = Vector3d::Zero();
  for (int k = 0; k < 4500; ++k) {
    // A metre out and back again, and still.
    if (k < 4000) input.X_WH.p += (k < 2000 ? 0.5e-3 : -0.5e-3) * outwards;
    const TickOutput out = tick.Step(input, channels);
    ASSERT_EQ(out.status, TickStatus::kOk);
    ASSERT_LE(out.F_Ho_W.head<3>().norm(), session.choice.coupling.max_force * (1 + 1e-12));
    before = out.F_Ho_W.head<3>();
  }
  EXPECT_GT(tick.summary().slipping, 100);
  EXPECT_FALSE(tick.dynamics().slipping());
  EXPECT_LT((tick.GraspFrame().p - input.X_WH.p).norm(), 0.01);
}

TEST(HardPlaces, PapersTickKeepsItsBranchAtDeadCentresAndReportsThem) {
  Session session(PistonInHand(), Vector3d(0.12, 0, 0));
  MechanismTickOptions options;
  options.law.stiffness << Vector3d::Constant(600), Vector3d::Constant(1);
  options.inertia = 0;
  MechanismTick tick(session.tree, 0, session.q, session.master.info(), options);
  Watched watched(&tick, tick.q());
  session.Run(&watched, SafetyOptions{});
  const TrackSummary& tracking = tick.tracking();
  EXPECT_GT(tracking.dead_centre + tracking.catching_up + tracking.jumps, 0);
  EXPECT_LT(watched.farthest, TrackOptions{}.max_move + 1e-9);
  EXPECT_LT(tracking.worst_closure, 1e-9);
}

}  // namespace
}  // namespace vmech::hard_places_test
