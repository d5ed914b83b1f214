#include "vmech/hw_interface/loop/runner.h"

#include <stdexcept>

#include <gtest/gtest.h>

#include "hw_interface/point_master.h"
#include "support/temp_folder.h"
#include "vmech/hw_interface/masters/simulated_master.h"
#include "vmech/hw_interface/recording/recording_file.h"

namespace vmech::runner_test {
namespace {

/// A spring from the hand to a point, `anchor` away from the grasp: the simplest mechanism.
class SpringTick : public Tick {
 public:
  explicit SpringTick(double stiffness) : stiffness_(stiffness) {}
  Posed X_WG;
  Vector3d anchor = Vector3d::Zero();
  int resets = 0;
  TickStatus status = TickStatus::kOk;
  std::vector<double> elapsed;

  std::vector<std::string> ChannelNames() const override { return {"stretch"}; }
  Posed GraspFrame() const noexcept override { return X_WG; }
  void Reset() noexcept override { ++resets; }
  TickOutput Step(const TickInput& input, std::span<double> channels) noexcept override {
    TickOutput out;
    out.status = status;
    const Vector3d stretch = input.X_WH.p - X_WG.p - anchor;
    out.F_Ho_W.head<3>() = -stiffness_ * stretch;
    out.stored_energy = 0.5 * stiffness_ * stretch.squaredNorm();
    channels[0] = stretch.norm();
    if (elapsed.size() < elapsed.capacity()) elapsed.push_back(input.elapsed);
    last_stretch = stretch;
    return out;
  }
  Vector3d last_stretch = Vector3d::Zero();

 private:
  double stiffness_;
};

RunnerOptions Quick(double seconds) {
  RunnerOptions options;
  options.seconds = seconds;
  options.realtime.reset();
  options.safety.soft_start = 0.01;
  return options;
}

/// Oversleeps at one slot.
class LateClock : public FreeRunningClock {
 public:
  void SleepUntil(std::int64_t time_ns) noexcept override {
    FreeRunningClock::SleepUntil(time_ns + (++sleeps_ == 10 ? 3'400'000 : 0));
  }

 private:
  int sleeps_ = 0;
};

TEST(Runner, RunsEverySlotOfItsTime) {
  PointMaster master(PointOptions{});
  master.Configure();
  SpringTick tick(100);
  FreeRunningClock clock;
  const RunSummary summary = Runner(Quick(0.5), &master, &tick, &clock).Run();
  EXPECT_EQ(summary.status, RunStatus::kFinished);
  EXPECT_EQ(summary.ticks, 500u);
  EXPECT_EQ(summary.skipped, 0u);
  EXPECT_EQ(summary.interval.Percentile(0.5), 1'000'000);
  EXPECT_EQ(master.lifecycle(), Lifecycle::kInactive);
}

TEST(Runner, SkipsSlotsThatHavePassedAndStaysOnTheGrid) {
  PointMaster master(PointOptions{});
  master.Configure();
  SpringTick tick(100);
  LateClock clock;
  Runner runner(Quick(0.1), &master, &tick, &clock);
  const RunSummary summary = runner.Run();
  EXPECT_EQ(summary.ticks, 97u);
  EXPECT_EQ(summary.skipped, 3u);
  EXPECT_EQ(summary.late.max(), 3'400'000);
  const Recording kept = runner.Kept();
  EXPECT_EQ(kept.ticks[9].skipped, 3);
  EXPECT_EQ(kept.ticks[9].late_ns, 400'000);
  for (const TickRecord& tick_record : kept.ticks) {
    EXPECT_EQ(tick_record.state.host_time_ns % 1'000'000, 0);
  }
}

TEST(Runner, TakesHoldWithoutAJump) {
  PointMaster master(PointOptions{});
  master.Configure();
  master.x = {0.3, -0.2, 0.1, 0.7};
  SpringTick tick(100);
  tick.X_WG.p = Vector3d(1, 2, 3);
  FreeRunningClock clock;
  const RunSummary summary = Runner(Quick(0.1), &master, &tick, &clock).Run();
  EXPECT_EQ(tick.resets, 1);
  EXPECT_LT(summary.peak_force, 1e-9);
}

TEST(Runner, PullsBackAHandThatLeavesTheMechanism) {
  PointOptions options;
  options.hand_stiffness = 50;
  options.hand_damping = 5;
  options.reach = 0.02;
  PointMaster master(options);
  master.Configure();
  SpringTick tick(200);
  RunnerOptions run = Quick(2);
  // The device stands turned: what it measures as x is the world's y.
  run.R_WD = Eigen::AngleAxisd(M_PI / 2, Vector3d::UnitZ()).toRotationMatrix();
  FreeRunningClock clock;
  Runner runner(run, &master, &tick, &clock);
  const RunSummary summary = runner.Run();
  EXPECT_EQ(summary.status, RunStatus::kFinished);
  EXPECT_GT(summary.peak_force, 0.5);
  for (const TickRecord& record : runner.Kept().ticks) {
    const Vector3d out = record.state.X_DH.p;
    EXPECT_LE(record.wanted_F_Ho_D.head<3>().dot(out), 1e-12);
  }
}

TEST(Runner, KeepsAndWritesTheLastTicksAfterAFault) {
  PointMaster master(PointOptions{});
  master.Configure();
  SpringTick tick(std::nan(""));
  RunnerOptions options = Quick(1);
  options.keep = 50;
  const TempFolder folder;
  options.post_mortem = folder / "post_mortem.csv";
  FreeRunningClock clock;
  const RunSummary summary = Runner(options, &master, &tick, &clock).Run();
  EXPECT_EQ(summary.status, RunStatus::kFault);
  EXPECT_EQ(summary.cause, ForceOff::kNonFinite);
  EXPECT_NE(summary.FullReport().find("fault: not a number"), std::string::npos);
  EXPECT_EQ(master.lifecycle(), Lifecycle::kInactive);
  const Recording last = ReadRecording(summary.post_mortem);
  EXPECT_EQ(last.ticks.back().off, ForceOff::kNonFinite);
  EXPECT_EQ(last.channels, std::vector<std::string>{"stretch"});
}

TEST(Runner, StopsWhenTheTickFails) {
  PointMaster master(PointOptions{});
  master.Configure();
  SpringTick tick(1);
  tick.status = TickStatus::kFailed;
  FreeRunningClock clock;
  const RunSummary summary = Runner(Quick(1), &master, &tick, &clock).Run();
  EXPECT_EQ(summary.status, RunStatus::kFault);
  EXPECT_EQ(summary.ticks, 1u);
  EXPECT_EQ(summary.peak_force, 0);
}

TEST(Runner, EmergencyStopEndsTheRunWithoutForce) {
  PointMaster master(PointOptions{});
  master.Configure();
  SpringTick tick(100);
  FreeRunningClock clock;
  RunnerOptions options = Quick(0);
  Runner runner(options, &master, &tick, &clock);
  runner.EmergencyStop();
  const RunSummary summary = runner.Run();
  EXPECT_EQ(summary.cause, ForceOff::kEmergencyStop);
  EXPECT_EQ(summary.ticks, 1u);
}

TEST(Runner, RecordsEveryTick) {
  PointMaster master(PointOptions{});
  master.Configure();
  SpringTick tick(100);
  RunnerOptions options = Quick(3);
  options.record = true;
  options.keep = 10;
  FreeRunningClock clock;
  Runner runner(options, &master, &tick, &clock);
  runner.Run();
  EXPECT_EQ(runner.Kept().ticks.size(), 3000u);
  RunnerOptions endless = Quick(0);
  endless.record = true;
  EXPECT_THROW(endless.Validate(), std::invalid_argument);
}

/// A page that comes late, and again much later.
class LookingClock : public FreeRunningClock {
 public:
  Runner* runner = nullptr;
  std::vector<double> forces;  // as it saw them [N]
  void SleepUntil(std::int64_t time_ns) noexcept override {
    FreeRunningClock::SleepUntil(time_ns);
    const std::uint64_t ticks = runner->live().ticks;
    if (ticks % 500 != 3 && ticks % 500 != 5) return;
    if (runner->pictures().Take()) forces.push_back(runner->pictures().front().F_Ho_W.x());
  }
};

TEST(Runner, ShowsTheFirstTickThatIsOverWhenThePictureHasBeenTaken) {
  PointMaster master(PointOptions{});
  master.Configure();
  SpringTick tick(100);
  tick.anchor.x() = 0.01;
  LookingClock clock;
  RunnerOptions options = Quick(1);
  options.record = true;
  Runner runner(options, &master, &tick, &clock);
  clock.runner = &runner;
  runner.Run();
  std::vector<double> expected;
  for (const size_t slot : {0, 3, 5, 503}) {
    expected.push_back(runner.Kept().ticks[slot].picture.F_Ho_W.x());
  }
  EXPECT_EQ(clock.forces, expected);
  EXPECT_NE(expected[0], expected[1]);
}

TEST(Runner, EverySlotOfTheGridIsTickedOrCountedAsSkipped) {
  PointMaster master(PointOptions{});
  master.Configure();
  SpringTick tick(100);
  WallClock clock;
  const std::int64_t start = clock.Now();
  const RunSummary summary = Runner(Quick(0.1), &master, &tick, &clock).Run();
  const std::uint64_t slots = summary.ticks + summary.skipped;
  EXPECT_GE(slots, 100u);  // more where the machine overslept the end
  EXPECT_LE((slots - 1) * 1'000'000, clock.Now() - start);
}

// A spring pulls at a hand that is a spring itself: the handle comes to rest where they balance,
// x = k/(k + k_hand) anchor. It would stay where it is without torques, and flee if they pushed.
TEST(Runner, SimulatedArmIsPulledToWhereTheSpringAndTheHandBalance) {
  constexpr double kStiffness = 50;
  const Vector3d anchor(0.02, -0.03, 0.01);
  SimulatedMasterOptions arm;
  SimulatedMaster master(arm);
  master.Configure();
  SpringTick tick(kStiffness);
  tick.anchor = anchor;
  FreeRunningClock clock;
  Runner runner(Quick(4), &master, &tick, &clock);
  const RunSummary summary = runner.Run();
  EXPECT_EQ(summary.status, RunStatus::kFinished) << summary.FullReport();
  const Vector3d balance = kStiffness / (kStiffness + arm.hand.stiffness) * anchor;
  const Vector3d moved = tick.last_stretch + anchor;
  EXPECT_LT((moved - balance).norm(), 0.1 * balance.norm()) << moved.transpose();
}

TEST(ArmTorques, PostureTorqueDoesNotAccelerateTheHandle) {
  const auto arm = std::make_shared<const ArmDescription>(SarcosMasterArm());
  ArmTorques torques(PostureOptions{}, arm, 1e-3, 1e-4);
  ArmModel model(arm);
  MasterState state;
  MasterCommand command;
  // From posture to posture, so that the motions found last do not always serve.
  for (int k = 0; k < 500; ++k) {
    for (int i = 0; i < 7; ++i) state.q[i] = arm->posture[i] + 0.7 * std::sin(0.03 * k * (i + 1));
    state.q[0] += 0.1;
    torques.Resolve(state, true, &command);
    model.SetPosture(state.q.data());
    const VectorXd tau = Eigen::Map<const VectorXd>(command.torque.data(), 7);
    EXPECT_GT(tau.norm(), 1e-3);
    const VectorXd vdot = model.MassMatrix().llt().solve(tau);
    EXPECT_LT((model.J() * vdot).norm(), 1e-6 * vdot.norm()) << k;
  }
}

TEST(ArmTorques, HoldAHairsBreadthFromThePostureTheyWereFoundAt) {
  const auto arm = std::make_shared<const ArmDescription>(SarcosMasterArm());
  ArmTorques torques(PostureOptions{}, arm, 1e-3, 1e-4);
  ArmModel model(arm);
  MasterState state;
  MasterCommand command;
  for (int i = 0; i < 7; ++i) state.q[i] = arm->posture[i] + 0.1 * (i % 3);
  const auto handle_acceleration = [&] {
    torques.Resolve(state, true, &command);
    model.SetPosture(state.q.data());
    const VectorXd tau = Eigen::Map<const VectorXd>(command.torque.data(), 7);
    const VectorXd vdot = model.MassMatrix().llt().solve(tau);
    return (model.J() * vdot).norm() / vdot.norm();
  };
  EXPECT_LT(handle_acceleration(), 1e-6);
  for (int i = 0; i < 7; ++i) state.q[i] += i % 2 == 0 ? 2.9e-3 : -2.9e-3;
  EXPECT_LT(handle_acceleration(), 1e-2);
  for (int i = 0; i < 7; ++i) state.q[i] += i % 2 == 0 ? 0.2e-3 : -0.2e-3;
  EXPECT_LT(handle_acceleration(), 1e-6);
}

TEST(ArmTorques, WithoutPostureAreThoseOfTheJacobian) {
  const auto arm = std::make_shared<const ArmDescription>(SarcosMasterArm());
  ArmTorques torques({0, 0}, arm, 1e-3, 1e-4);
  MasterState state;
  for (int i = 0; i < 7; ++i) state.q[i] = arm->posture[i];
  MasterCommand command;
  command.F_Ho_D << 1, 2, 3, 0.1, 0.2, 0.3;
  torques.Resolve(state, true, &command);
  const VectorXd expected = ArmModel(arm).J().transpose() * command.F_Ho_D;
  EXPECT_LT((Eigen::Map<const VectorXd>(command.torque.data(), 7) - expected).norm(), 1e-12);
}

TEST(RealtimeScope, SaysWhatItWasRefused) {
  RealtimeOptions options;
  const RealtimeScope scope(options);
  const RealtimeReport& report = scope.report();
  EXPECT_EQ(report.refused.size(), (report.memory_locked ? 0u : 1u) + (report.fifo ? 0u : 1u));
  EXPECT_NE(report.BriefReport().find(report.fifo ? "SCHED_FIFO" : "refused"), std::string::npos);
  EXPECT_THROW(RealtimeScope({true, 100}), std::invalid_argument);
}

TEST(FlushToZero, TakesSmallNumbersForZeroAndGivesThemBack) {
  volatile double tiny = 1e-300;
  const unsigned mode = SetFlushToZero();
  EXPECT_EQ(tiny * 1e-10, 0);
  RestoreFloatingPoint(mode);
  EXPECT_GT(tiny * 1e-10, 0);
}

}  // namespace
}  // namespace vmech::runner_test
