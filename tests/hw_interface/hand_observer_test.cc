#include "vmech/hw_interface/estimation/hand_observer.h"

#include <gtest/gtest.h>

#include "hw_interface/tick_input.h"
#include "support/examples.h"
#include "vmech/hw_interface/loop/runner.h"
#include "vmech/hw_interface/masters/simulated_master.h"
#include "vmech/hw_interface/rendering/coupled_tick.h"
#include "vmech/hw_interface/rendering/coupling_choice.h"

namespace vmech::hand_observer_test {
namespace {

constexpr std::int64_t kPeriodNs = 1'000'000;

/// An arm that pushes its own handle to and fro, 40 times a second; the hand follows by its weight.
struct Pushed {
  Pushed() : master(SimulatedMasterOptions{}) {
    master.Configure();
    master.Activate();
  }
  /// The true velocity of the handle.
  Vector3d Push(int k) {
    (void)master.Read(kPeriodNs * k, &state);
    MasterCommand command;
    command.mode = CommandMode::kWrench;
    command.F_Ho_D[1] = 20 * std::sin(0.25 * k);
    (void)master.Write(command);
    ArmModel truth(master.info().arm);
    truth.SetPosture(master.q().data());
    return (truth.J() * master.v()).head<3>();
  }

  SimulatedMaster master;
  MasterState state;
};

TEST(HandObserver, KnowsWhatTheArmDoesToItsHandleBetterThanItsSamples) {
  Pushed arm;
  HandObserver observer({}, arm.master.info());
  double observed = 0, differences = 0;
  Vector3d last = Vector3d::Zero();
  for (int k = 0; k < 1000; ++k) {
    const Vector3d v = arm.Push(k);
    observer.Update(arm.state, arm.state.applied_F_Ho_D, 1);
    if (k >= 500) {
      observed += (observer.V_DH().head<3>() - v).squaredNorm();
      differences += (1000 * (arm.state.X_DH.p - last) - v).squaredNorm();
    }
    last = arm.state.X_DH.p;
    EXPECT_LT((observer.X_DH().p - arm.state.X_DH.p).norm(),
              2 * arm.master.info().linear.resolution);
  }
  EXPECT_LT(observed, 0.25 * differences);
}

TEST(HandObserver, KeepsOffWhileAJointLeansOnItsStop) {
  SimulatedMaster master;
  master.Configure();
  HandObserver observer({}, master.info());
  MasterState state;
  (void)master.Read(0, &state);
  observer.Update(state, Vector6d::Zero(), 1);
  EXPECT_EQ(observer.trust(), 1);
  const MasterState free = state;
  state.q[0] = 10;
  for (int k = 0; k < 11; ++k) observer.Update(state, Vector6d::Zero(), 1);
  EXPECT_EQ(observer.trust(), 0);
  EXPECT_EQ((observer.X_DH().p - state.X_DH.p).norm(), 0);
  for (int k = 0; k < 51; ++k) observer.Update(free, Vector6d::Zero(), 1);
  EXPECT_EQ(observer.trust(), 1);
}

TEST(HandObserver, NeedsAnArmThatSaysWhatItIs) {
  DeviceInfo device;
  device.takes_wrench = true;
  EXPECT_FALSE(HandObserver::Suits(device));
  EXPECT_THROW(HandObserver({}, device), std::invalid_argument);
  EXPECT_THROW(HandObserverOptions{10}.Validate(), std::invalid_argument);
}

struct Unrest {
  double rms = 0, step = 0;  // of the force; its largest change from a tick to the next [N]
};

/// Of the force on a hand that holds still behind encoders of 16 bits.
Unrest AtRest(const std::string& name, double bandwidth) {
  const Mechanism mechanism = Example(name);
  const KinematicTree tree = BuildKinematicTree(mechanism);
  const VectorXd q = ClosedStart(tree);
  SimulatedMasterOptions arm;
  arm.hand = ImpedanceOf(Grip::kFirm);
  SimulatedMaster master(arm);
  master.Configure();
  const int grasp = FindGrasp(mechanism, "handle");
  CoupledTickOptions options;
  const CouplingChoice choice =
      ChooseCoupling(tree, GraspFrameOf(tree, grasp), q, master.info(), options.smoothing);
  options.coupling = choice.coupling;
  options.scale = choice.scale;
  CoupledTick tick(tree, grasp, q, master.info().period, options);
  RunnerOptions run;
  run.seconds = 4;
  run.record = true;
  run.realtime.reset();
  run.safety = choice.Safety();
  run.observer.bandwidth = bandwidth;
  FreeRunningClock clock;
  Runner runner(run, &master, &tick, &clock);
  const RunSummary summary = runner.Run();
  EXPECT_EQ(summary.status, RunStatus::kFinished) << summary.FullReport();
  const Recording kept = runner.Kept();
  constexpr size_t kSettled = 2000;
  Vector3d mean = Vector3d::Zero();
  const double count = static_cast<double>(kept.ticks.size() - kSettled);
  for (size_t k = kSettled; k < kept.ticks.size(); ++k) {
    mean += kept.ticks[k].sent_F_Ho_D.head<3>() / count;
  }
  Unrest unrest;
  for (size_t k = kSettled; k < kept.ticks.size(); ++k) {
    const Vector3d force = kept.ticks[k].sent_F_Ho_D.head<3>();
    const Vector3d before = kept.ticks[k - 1].sent_F_Ho_D.head<3>();
    unrest.rms += (force - mean).squaredNorm() / count;
    unrest.step = std::max(unrest.step, (force - before).norm());
  }
  unrest.rms = std::sqrt(unrest.rms);
  return unrest;
}

TEST(HandObserver, QuietensTheForceOnAHandAtRest) {
  for (const char* name : {"crank", "slider-crank", "four-bar", "bennett", "stewart-gough"}) {
    const Unrest with = AtRest(name, 120), without = AtRest(name, 0);
    EXPECT_LT(with.rms, 0.7 * without.rms) << name;
    EXPECT_LT(with.step, 0.4 * without.step) << name;
    EXPECT_LT(with.rms, 1.5) << name;  // [N]
  }
}

}  // namespace
}  // namespace vmech::hand_observer_test
