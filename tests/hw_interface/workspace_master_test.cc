#include "vmech/hw_interface/masters/workspace_master.h"

#include <stdexcept>

#include <gtest/gtest.h>

#include "hw_interface/point_master.h"
#include "vmech/hw_interface/safety/safety_filter.h"

namespace vmech::workspace_master_test {
namespace {

/// A device whose handle, buttons and force are the test's.
class HandMovedMaster : public Master {
 public:
  ~HandMovedMaster() override { Shutdown(); }
  MasterState state;
  Vector6d force = Vector6d::Zero();
  DeviceInfo stated;

 private:
  DeviceInfo OnConfigure() override {
    stated.takes_wrench = true;
    stated.senses = kSensesPose | kSensesButtons;
    return stated;
  }
  IoStatus OnRead(std::int64_t, MasterState* out) noexcept override {
    ++state.sequence;
    state.valid = info().senses;
    state.dead_man = true;
    *out = state;
    return IoStatus::kOk;
  }
  IoStatus OnWrite(const MasterCommand& command) noexcept override {
    force = command.mode == CommandMode::kWrench ? command.F_Ho_D : Vector6d::Zero().eval();
    return IoStatus::kOk;
  }
};

class Workspace : public testing::Test {
 protected:
  void Start(double motion_scale, int clutch) {
    auto device = std::make_unique<HandMovedMaster>();
    device->stated.linear = {0.4, 3, 0.2, 1e-5, 8, 1};
    device->stated.angular = {0, 0, 0, 0, 0, 10};
    device_ = device.get();
    WorkspaceOptions options;
    options.motion_scale = motion_scale;
    options.clutch = clutch;
    master_ = std::make_unique<WorkspaceMaster>(options, std::move(device));
    master_->Configure();
    master_->Activate();
  }
  MasterState ReadAt(const Vector3d& p, bool pressed = false) {
    device_->state.X_DH.p = p;
    device_->state.buttons = pressed ? 4 : 0;
    MasterState state;
    EXPECT_EQ(master_->Read(0, &state), IoStatus::kOk);
    return state;
  }
  void Write(double force, CommandMode mode = CommandMode::kWrench) {
    MasterCommand command;
    command.mode = mode;
    command.F_Ho_D[0] = force;
    EXPECT_EQ(master_->Write(command), IoStatus::kOk);
  }

  HandMovedMaster* device_ = nullptr;
  std::unique_ptr<WorkspaceMaster> master_;
};

// Power, kinetic energy and loss are the same on both sides of the scale.
TEST_F(Workspace, ScaleKeepsPowerAndEnergy) {
  Start(3, -1);
  const HandlePhysics seen = master_->info().linear, real = device_->info().linear;
  const double v = 0.2, force = 2;
  EXPECT_NEAR(seen.mass * std::pow(3 * v, 2), real.mass * v * v, 1e-15);
  EXPECT_NEAR(seen.damping * std::pow(3 * v, 2), real.damping * v * v, 1e-15);
  EXPECT_NEAR(seen.coulomb * 3 * v, real.coulomb * v, 1e-15);
  EXPECT_NEAR(seen.resolution, 3 * real.resolution, 1e-18);
  EXPECT_NEAR(seen.peak * seen.max_speed, real.peak * real.max_speed, 1e-14);
  const Vector3d start(0.1, 0.2, 0.3);
  EXPECT_EQ(ReadAt(start).X_DH.p, 3 * start);
  device_->state.V_DH[0] = v;
  const MasterState moved = ReadAt(start + Vector3d(0.01, 0, 0));
  EXPECT_NEAR(moved.X_DH.p.x() - 3 * start.x(), 0.03, 1e-15);
  Write(force);
  EXPECT_NEAR(device_->force[0] * v, force * moved.V_DH[0], 1e-15);
}

// The passivity filter sees through the scale what happens at the real handle: the same energy.
TEST_F(Workspace, EnergyOfASessionIsThatOfTheRealHandle) {
  PointOptions options;
  options.hand_stiffness = 300;
  options.hand_damping = 5;
  options.reach = 0.02;
  options.senses_wrench = true;
  auto device = std::make_unique<PointMaster>(options);
  const PointMaster* point = device.get();
  WorkspaceOptions workspace;
  workspace.motion_scale = 4;
  WorkspaceMaster master(workspace, std::move(device));
  master.Configure();
  master.Activate();
  MasterState state, last;
  double seen = 0, real = 0;
  Vector3d x = Vector3d::Zero();
  for (std::int64_t k = 0; k < 2000; ++k) {
    ASSERT_EQ(master.Read(k * 1'000'000, &state), IoStatus::kOk);
    const Vector3d now(point->x[0], point->x[1], point->x[2]);
    const Vector3d force(point->force[0], point->force[1], point->force[2]);
    if (k > 0) {
      const Vector3d way = state.X_DH.p - last.X_DH.p;
      seen += state.applied_F_Ho_D.head<3>().dot(way) -
              master.info().linear.damping * way.squaredNorm() / 1e-3;
      real += force.dot(now - x) - options.damping * (now - x).squaredNorm() / 1e-3;
    }
    x = now;
    last = state;
    MasterCommand command;
    command.mode = CommandMode::kWrench;
    command.F_Ho_D.head<3>() = -50 * state.X_DH.p;
    ASSERT_EQ(master.Write(command), IoStatus::kOk);
  }
  EXPECT_LT(real, -1e-3);
  EXPECT_NEAR(seen, real, 1e-12);
}

TEST_F(Workspace, ClutchMovesTheHandleAlone) {
  Start(2, 2);
  EXPECT_TRUE(master_->info().has_dead_man);
  ReadAt({0, 0, 0});
  EXPECT_TRUE(ReadAt({0.01, 0, 0}).dead_man);
  const MasterState pressed = ReadAt({0.05, 0, 0}, true);
  EXPECT_FALSE(pressed.dead_man);
  EXPECT_EQ(pressed.X_DH.p, Vector3d(0.02, 0, 0));
  EXPECT_EQ(ReadAt({-0.03, 0, 0}, true).X_DH.p, pressed.X_DH.p);
  const MasterState again = ReadAt({-0.03, 0, 0});
  EXPECT_TRUE(again.dead_man);
  EXPECT_EQ(again.X_DH.p, pressed.X_DH.p);
  EXPECT_NEAR(ReadAt({-0.02, 0, 0}).X_DH.p.x(), 0.04, 1e-15);
}

TEST_F(Workspace, ClutchKeepsTheOrientationToo) {
  Start(1, 2);
  const auto turn = [&](double angle, bool pressed) {
    device_->state.X_DH.R = Eigen::AngleAxisd(angle, Vector3d::UnitZ()).toRotationMatrix();
    const Matrix3d R = ReadAt({0, 0, 0}, pressed).X_DH.R;
    return std::atan2(R(1, 0), R(0, 0));
  };
  EXPECT_NEAR(turn(0.1, false), 0.1, 1e-15);
  EXPECT_NEAR(turn(0.5, true), 0.1, 1e-15);
  EXPECT_NEAR(turn(0.5, false), 0.1, 1e-15);
  EXPECT_NEAR(turn(0.7, false), 0.3, 1e-15);
}

TEST_F(Workspace, ForceFallsByTheRateWhenTheClutchIsPressed) {
  Start(1, 2);
  ReadAt({0, 0, 0});
  Write(5);
  ReadAt({0, 0, 0}, true);
  for (const double left : {4.0, 3.0, 2.0, 1.0, 0.0, 0.0}) {
    Write(0, CommandMode::kZero);
    EXPECT_NEAR(device_->force[0], left, 1e-12);
  }
}

TEST_F(Workspace, EmergencyStopTakesAllAtOnce) {
  Start(1, 2);
  ReadAt({0, 0, 0});
  Write(5);
  device_->state.emergency_stop = true;
  ReadAt({0, 0, 0}, true);
  Write(0, CommandMode::kZero);
  EXPECT_EQ(device_->force[0], 0);
}

// From full force through the clutch and back, behind the safety filter: no step beyond its own.
TEST_F(Workspace, ForceComesBackWithoutABlow) {
  Start(1, 2);
  SafetyOptions options;
  options.max_moment = 1;
  SafetyFilter filter(options, master_->info());
  double last = 0, largest = 0, end = 0;
  for (int k = 0; k < 2000; ++k) {
    const bool pressed = k >= 1000 && k < 1200;
    const MasterState state = ReadAt({pressed ? 1e-4 * (k - 1000) : 0, 0, 0}, pressed);
    const Vector6d wanted = Vector6d::Unit(0) * 6;
    const SafetyOutput safe =
        filter.Apply({master_->lifecycle(), IoStatus::kOk, &state, wanted, 0});
    Write(safe.F_Ho_D[0], safe.off == ForceOff::kNone ? CommandMode::kWrench : CommandMode::kZero);
    end = device_->force[0];
    largest = std::max(largest, std::abs(end - last));
    last = end;
    if (k == 999) EXPECT_EQ(end, 6);
    if (k == 1199) EXPECT_EQ(end, 0);
  }
  EXPECT_EQ(end, 6);
  EXPECT_LE(largest, 1 + 1e-12);
}

TEST(WorkspaceMaster, SaysWhatCannotBe) {
  EXPECT_THROW(WorkspaceMaster({0, -1, {}, 1000}, nullptr), std::invalid_argument);
  EXPECT_THROW(WorkspaceMaster({1, 32, {}, 1000}, nullptr), std::invalid_argument);
}

TEST(WorkspaceMaster, WhatIsKnownOfTheHandleStandsForWhatItStates) {
  WorkspaceOptions options;
  EXPECT_TRUE(options.AsItIs());
  options.known = {0.6, 0, 0.1, 0, /*peak=*/30, 2};
  EXPECT_FALSE(options.AsItIs());
  WorkspaceMaster master(options, std::make_unique<PointMaster>(PointOptions{}));
  master.Configure();
  EXPECT_EQ(master.info().linear.mass, 0.6);
  EXPECT_EQ(master.info().linear.damping, 2);  // its own
  EXPECT_EQ(master.info().linear.coulomb, 0.1);
  EXPECT_EQ(master.info().linear.peak, 20);  // no more than it has
  EXPECT_EQ(master.info().linear.max_speed, 2);
}

}  // namespace
}  // namespace vmech::workspace_master_test
