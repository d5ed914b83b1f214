#include "vmech/hw_interface/masters/simulated_master.h"

#include <gtest/gtest.h>

#include <numbers>
#include <stdexcept>

namespace vmech::simulated_master_test {
namespace {

constexpr std::int64_t kTick = 1'000'000;  // [ns]

/// An arm that nobody holds, with a perfect encoder.
SimulatedMasterOptions Free() {
  SimulatedMasterOptions options;
  options.hand = ImpedanceOf(Grip::kAbsent);
  options.encoder_bits = 0;
  return options;
}

/// Reads and writes one command for every millisecond up to `seconds`.
MasterState Drive(SimulatedMaster* master, double seconds, const MasterCommand& command = {}) {
  MasterState state;
  const auto ticks = std::llround(seconds * 1e3);
  for (std::int64_t i = 0; i <= ticks; ++i) {
    EXPECT_NE(master->Read(i * kTick, &state), IoStatus::kDeviceFault);
    if (i == ticks) break;
    EXPECT_EQ(master->Write(command), IoStatus::kOk);
  }
  return state;
}

MasterCommand Force(const Vector3d& f) {
  MasterCommand command;
  command.mode = CommandMode::kWrench;
  command.F_Ho_D.head<3>() = f;
  return command;
}

TEST(SimulatedMaster, KeepsItsEnergyWhenNothingActs) {
  ArmDescription arm = SarcosMasterArm();
  for (Joint& joint : arm.tree.mechanism.joints) {
    joint.passive[0].viscous = 0;
    joint.lower = {-1e9};
    joint.upper = {1e9};
  }
  const auto drift = [&](int substeps) {
    SimulatedMasterOptions options = Free();
    options.compensates_gravity = false;
    options.substeps = substeps;
    SimulatedMaster master(options, arm);
    master.Configure();
    const double start = master.Energy();
    Drive(&master, 1);
    EXPECT_GT(master.v().norm(), 1);  // it swings
    return std::abs(master.Energy() - start);
  };
  // Fourth order: half the step, 1/16 of the drift (its leading terms may partly cancel).
  const double coarse = drift(1), fine = drift(2);
  EXPECT_LT(fine, 1e-5);
  EXPECT_LT(fine, coarse / 8);
}

TEST(SimulatedMaster, HangsStillWithGravityCompensated) {
  SimulatedMaster master(Free());
  master.Configure();
  Drive(&master, 1);
  EXPECT_LT(master.v().norm(), 1e-9);
}

TEST(SimulatedMaster, MovesAlongTheForceOfItsMotors) {
  SimulatedMaster master(Free());
  master.Configure();
  master.Activate();
  MasterState before, after;
  ASSERT_EQ(master.Read(0, &before), IoStatus::kOk);
  after = Drive(&master, 0.05, Force({0, 0, 4}));
  EXPECT_GT((after.X_DH.p - before.X_DH.p).z(), 1e-4);
  EXPECT_EQ(after.applied_F_Ho_D[2], 4);
}

TEST(SimulatedMaster, DelayTakesWholePeriods) {
  SimulatedMasterOptions options = Free();
  options.delay_periods = 3;
  SimulatedMaster master(options);
  master.Configure();
  master.Activate();
  MasterState state;
  MasterCommand command = Force({0, 0, 4});
  for (int i = 0; i <= 4; ++i) {
    ASSERT_EQ(master.Read(i * kTick, &state), IoStatus::kOk);
    EXPECT_EQ(state.applied_F_Ho_D[2], i < 4 ? 0 : 4) << i;
    ASSERT_EQ(master.Write(command), IoStatus::kOk);
  }
}

TEST(SimulatedMaster, LetsGoWhenACommandHasExpired) {
  SimulatedMaster master(Free());
  master.Configure();
  master.Activate();
  MasterState state;
  MasterCommand command = Force({0, 0, 4});
  command.valid_until_ns = 5 * kTick;
  ASSERT_EQ(master.Read(0, &state), IoStatus::kOk);
  ASSERT_EQ(master.Write(command), IoStatus::kOk);
  ASSERT_EQ(master.Read(4 * kTick, &state), IoStatus::kOk);
  EXPECT_EQ(state.applied_F_Ho_D[2], 4);
  ASSERT_EQ(master.Read(8 * kTick, &state), IoStatus::kOk);
  EXPECT_EQ(state.applied_F_Ho_D[2], 0);
}

TEST(SimulatedMaster, LimitsTorquesAsOneVector) {
  SimulatedMaster master(Free());
  master.Configure();
  master.Activate();
  MasterState state;
  ASSERT_EQ(master.Read(0, &state), IoStatus::kOk);
  ASSERT_EQ(master.Write(Force({300, 400, 0})), IoStatus::kOk);
  ASSERT_EQ(master.Read(kTick, &state), IoStatus::kOk);
  const Vector6d F = state.applied_F_Ho_D;
  EXPECT_LT(F.norm(), 500);
  EXPECT_GT(F.norm(), 10);
  EXPECT_NEAR(F[0] / F[1], 0.75, 1e-12);
}

TEST(SimulatedMaster, MeasuresWholeCounts) {
  SimulatedMasterOptions options;
  options.encoder_bits = 12;
  SimulatedMaster master(options);
  master.Configure();
  master.Activate();
  const MasterState state = Drive(&master, 0.1, Force({5, 0, 0}));
  const double count = 2 * std::numbers::pi / 4096;
  for (int i = 0; i < 7; ++i) {
    EXPECT_NEAR(std::remainder(state.q[i], count), 0, 1e-12);
    EXPECT_LE(std::abs(state.q[i] - master.q()[i]), count / 2);
  }
}

TEST(SimulatedMaster, FirmHandBringsTheHandleToItsTarget) {
  SimulatedMaster probe(Free());
  const Posed start = ArmModel(std::make_shared<const ArmDescription>(SarcosMasterArm())).X_DH();
  Posed goal = start;
  goal.p += Vector3d(0.02, -0.03, 0.04);
  SimulatedMasterOptions options;
  options.hand = ImpedanceOf(Grip::kFirm);
  options.hand.mass = 0;
  options.motion = ReachTo(start, goal, 0.1, 0.6);
  SimulatedMaster master(options);
  master.Configure();
  const MasterState state = Drive(&master, 4);
  EXPECT_LT((state.X_DH.p - goal.p).norm(), 1e-3);
}

TEST(SimulatedMaster, SameCallsGiveTheSameBits) {
  SimulatedMasterOptions options;
  options.lost_share = 0.1;
  SimulatedMaster one(options), two(options);
  for (SimulatedMaster* master : {&one, &two}) {
    master->Configure();
    master->Activate();
    Drive(master, 0.2, Force({5, -3, 2}));
  }
  EXPECT_EQ(one.q(), two.q());
}

TEST(SimulatedMaster, StaysWithinItsStops) {
  SimulatedMasterOptions options = Free();
  options.compensates_gravity = false;
  SimulatedMaster master(options);
  master.Configure();
  Drive(&master, 3);
  const Mechanism& arm = master.info().arm->tree.mechanism;
  for (int i = 0; i < 7; ++i) {
    EXPECT_GT(master.q()[i], arm.joints[i].lower[0] - 0.2);
    EXPECT_LT(master.q()[i], arm.joints[i].upper[0] + 0.2);
  }
}

TEST(SimulatedMaster, StatesNoMoreDampingThanEveryDirectionHas) {
  SimulatedMaster master;
  master.Configure();
  const DeviceInfo& info = master.info();
  ArmModel arm(info.arm);
  const MatrixXd J = arm.J().topRows<3>();
  VectorXd damping(7);
  for (int i = 0; i < 7; ++i) damping[i] = info.arm->tree.mechanism.joints[i].passive[0].viscous;
  const Matrix3d B = (J * damping.cwiseInverse().asDiagonal() * J.transpose()).inverse();
  for (int i = 0; i < 3; ++i) EXPECT_LE(info.linear.damping, B(i, i));
  EXPECT_GT(info.linear.damping, 0.1);
  EXPECT_NEAR(info.linear.resolution, 1e-4, 0.9e-4);
}

TEST(SimulatedMaster, SqueezeClosesTheGripper) {
  SimulatedMasterOptions options;
  options.squeeze = [](double time) { return time > 0.1 ? 0.5 : 0.0; };
  SimulatedMaster master(options);
  master.Configure();
  EXPECT_GT(Drive(&master, 0.05).gripper_opening, 0.3);
  SimulatedMaster closed(options);
  closed.Configure();
  EXPECT_EQ(Drive(&closed, 0.5).gripper_opening, 0);
}

TEST(SimulatedMasterOptions, NameWhatIsOutOfRange) {
  SimulatedMasterOptions options;
  options.period = 3;
  try {
    options.Validate();
    FAIL() << "accepted";
  } catch (const std::invalid_argument& error) {
    EXPECT_STREQ(error.what(), "SimulatedMasterOptions.period = 3, must be in [1e-05, 0.1]");
  }
}

}  // namespace
}  // namespace vmech::simulated_master_test
