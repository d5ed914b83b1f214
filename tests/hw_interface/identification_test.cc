#include "vmech/hw_interface/probing/identification.h"

#include <stdexcept>

#include <gtest/gtest.h>

#include "hw_interface/point_master.h"
#include "vmech/hw_interface/loop/runner.h"
#include "vmech/hw_interface/masters/simulated_master.h"
#include "vmech/hw_interface/probing/probe_ticks.h"

namespace vmech::identification_test {
namespace {

struct Shaken {
  RunSummary summary;
  Recording recording;
};

Shaken Shake(const ShakeOptions& shake, Master* master) {
  if (master->lifecycle() == Lifecycle::kUnconfigured) master->Configure();
  ShakeTick tick(shake, master->info().period);
  FreeRunningClock clock;
  RunnerOptions options;
  options.seconds = shake.total_seconds();
  options.record = true;
  options.realtime.reset();
  options.joint_torques = false;
  options.safety = ProbeSafety(std::max(shake.force, shake.blows_to), shake.speed);
  Runner runner(options, master, &tick, &clock);
  Shaken run{runner.Run(), {}};
  run.recording = runner.Kept();
  return run;
}

// An exact mass on a damper: the truth is what it was made of.
TEST(FitHandle, FindsMassDampingAndDelayOfAPoint) {
  for (const int delay : {0, 3}) {
    PointOptions options;
    options.mass = 0.3;
    options.damping = 1.5;
    options.delay_periods = delay;
    PointMaster master(options);
    const Shaken run = Shake({}, &master);
    ASSERT_EQ(run.summary.status, RunStatus::kFinished) << run.summary.FullReport();
    const HandleFit fit = FitHandle(run.recording);
    for (const AxisFit& axis : fit.axes) {
      EXPECT_NEAR(axis.mass, 0.3, 0.3 * 0.01);
      EXPECT_NEAR(axis.damping, 1.5, 1.5 * 0.02);
      EXPECT_NEAR(axis.coulomb, 0, 0.01);
      EXPECT_LT(axis.unexplained, 0.02);
    }
    EXPECT_NEAR(fit.delay, 1e-3 * delay, 0.3e-3);
  }
}

TEST(FitHandle, FindsDryFrictionBesideDamping) {
  PointOptions options;
  options.mass = 0.25;
  options.damping = 0.8;
  options.coulomb = 0.2;
  PointMaster master(options);
  const HandleFit fit = FitHandle(Shake({}, &master).recording);
  for (const AxisFit& axis : fit.axes) {
    EXPECT_NEAR(axis.mass, 0.25, 0.25 * 0.03);
    EXPECT_NEAR(axis.coulomb, 0.2, 0.2 * 0.1);
    // At a tenth of a metre per second dry friction is most of it: what is sure is the sum.
    EXPECT_NEAR(axis.coulomb + 0.1 * axis.damping, 0.28, 0.28 * 0.05) << axis.damping;
  }
}

/// The arm's apparent mass along an axis with the others free: 1 / (J M^-1 J')_ii.
Vector3d ApparentMasses(const SimulatedMaster& master) {
  ArmModel arm(master.info().arm);
  arm.SetPosture(arm.description().posture.data());
  const auto J = arm.J().topRows<3>();
  const Matrix3d mobility = J * arm.MassMatrix().llt().solve(J.transpose());
  return mobility.diagonal().cwiseInverse();
}

// The simulated arm that nobody holds: seven joints, 16-bit encoders, gravity carried by its
// motors.
TEST(FitHandle, FindsTheApparentMassOfAnArm) {
  SimulatedMasterOptions options;
  options.hand = ImpedanceOf(Grip::kAbsent);
  SimulatedMaster master(options);
  ShakeOptions shake;
  shake.force = 4;
  const Shaken run = Shake(shake, &master);
  ASSERT_EQ(run.summary.status, RunStatus::kFinished) << run.summary.FullReport();
  EXPECT_LE(run.summary.peak_force, 4);
  const HandleFit fit = FitHandle(run.recording);
  const Vector3d truth = ApparentMasses(master);
  for (int i = 0; i < 3; ++i) {
    const AxisFit& axis = fit.axes[static_cast<std::size_t>(i)];
    EXPECT_NEAR(axis.mass, truth[i], 0.05 * truth[i]) << i;
    EXPECT_LT(axis.travel, 0.06);
  }
}

// Motors that give less than they are asked for give themselves away by the handle's motion.
TEST(FitPeak, FindsWhereTheMotorsSaturate) {
  PointOptions options;
  options.mass = 0.3;
  options.peak = 20;
  options.saturates_at = 6;
  PointMaster master(options);
  const HandleFit handle = FitHandle(Shake({}, &master).recording);
  ShakeOptions shake;
  shake.blows_to = 12;
  shake.mass = handle.Physics().mass;
  shake.speed = 0.3;
  const Shaken run = Shake(shake, &master);
  ASSERT_EQ(run.summary.status, RunStatus::kFinished) << run.summary.FullReport();
  const PeakFit peak = FitPeak(run.recording, handle);
  EXPECT_TRUE(peak.reached);
  EXPECT_NEAR(peak.peak, 6, 6 * 0.05);
  shake.blows_to = 5;
  const PeakFit whole = FitPeak(Shake(shake, &master).recording, handle);
  EXPECT_FALSE(whole.reached);
  EXPECT_NEAR(whole.peak, 5, 1e-9);
}

TEST(ShakeTick, StopsWhereTheHandleRunsAway) {
  PointOptions options;
  PointMaster master(options);
  master.Configure();
  master.v[1] = 0.5;  // somebody pushes
  const Shaken run = Shake({}, &master);
  EXPECT_EQ(run.summary.status, RunStatus::kFault);
  EXPECT_EQ(run.summary.cause, ForceOff::kSpeed);
  EXPECT_TRUE(run.recording.ticks.back().sent_F_Ho_D.isZero(0));
  EXPECT_EQ(master.lifecycle(), Lifecycle::kInactive);
}

TEST(FitHandle, SaysWhatItCannotTell) {
  PointOptions options;
  options.hand_stiffness = 5e4;
  options.hand_damping = 100;
  PointMaster held(options);
  EXPECT_THROW(FitHandle(Shake({}, &held).recording), std::runtime_error);
  EXPECT_THROW(FitHandle(Recording{}), std::runtime_error);
  EXPECT_THROW(FitPeak(Shake({}, &held).recording, {}), std::runtime_error);
}

TEST(GuideTick, BringsTheHandleHomeAndSaysSo) {
  PointMaster master({});
  master.Configure();
  const Vector3d home(0.08, -0.05, 0.02);
  Runner* running = nullptr;
  GuideTick tick(home, 2, 1e-3, [&] { running->Stop(); });
  FreeRunningClock clock;
  RunnerOptions options;
  options.seconds = 20;
  options.realtime.reset();
  options.safety = ProbeSafety(2, 0.25);
  Runner runner(options, &master, &tick, &clock);
  running = &runner;
  const RunSummary summary = runner.Run();
  EXPECT_EQ(summary.status, RunStatus::kStopped) << summary.FullReport();
  EXPECT_LE(summary.peak_force, 2 + 1e-12);
  EXPECT_LT((Vector3d(master.x[0], master.x[1], master.x[2]) - home).norm(), 3e-3);
}

}  // namespace
}  // namespace vmech::identification_test
