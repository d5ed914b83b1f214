#include "vmech/hw_interface/masters/master.h"

#include <stdexcept>

#include <gtest/gtest.h>

namespace vmech {
namespace {

/// A driver that remembers what reached it.
class RecordingMaster : public Master {
 public:
  ~RecordingMaster() override { Shutdown(); }
  MasterCommand last;
  IoStatus next_read = IoStatus::kOk;
  DeviceInfo stated;
  bool let_go = false;

 private:
  DeviceInfo OnConfigure() override {
    stated.takes_wrench = true;
    return stated;
  }
  void OnShutdown() noexcept override { let_go = true; }
  IoStatus OnRead(std::int64_t, MasterState*) noexcept override { return next_read; }
  IoStatus OnWrite(const MasterCommand& command) noexcept override {
    last = command;
    return IoStatus::kOk;
  }
};

MasterCommand Push() {
  MasterCommand command;
  command.sequence = 7;
  command.mode = CommandMode::kWrench;
  command.F_Ho_D[0] = 3;
  return command;
}

TEST(Master, PassesCommandsOnlyWhileActive) {
  RecordingMaster master;
  master.Configure();
  EXPECT_EQ(master.Write(Push()), IoStatus::kOk);
  EXPECT_EQ(master.last.mode, CommandMode::kZero);
  EXPECT_EQ(master.last.sequence, 7u);
  master.Activate();
  EXPECT_EQ(master.Write(Push()), IoStatus::kOk);
  EXPECT_EQ(master.last.F_Ho_D[0], 3);
}

TEST(Master, SendsZeroWhenItIsDeactivated) {
  RecordingMaster master;
  master.Configure();
  master.Activate();
  EXPECT_EQ(master.Write(Push()), IoStatus::kOk);
  master.Deactivate();
  EXPECT_EQ(master.last.mode, CommandMode::kZero);
  EXPECT_EQ(master.lifecycle(), Lifecycle::kInactive);
}

TEST(Master, RefusesAModeThatTheDeviceDoesNotTake) {
  RecordingMaster master;
  master.Configure();
  master.Activate();
  MasterCommand command = Push();
  command.mode = CommandMode::kJointTorque;
  EXPECT_EQ(master.Write(command), IoStatus::kRefused);
  EXPECT_EQ(master.last.mode, CommandMode::kZero);
}

TEST(Master, StaysAtFaultUntilItRecovers) {
  RecordingMaster master;
  master.Configure();
  master.Activate();
  master.next_read = IoStatus::kDeviceFault;
  MasterState state;
  EXPECT_EQ(master.Read(5, &state), IoStatus::kDeviceFault);
  EXPECT_EQ(state.host_time_ns, 5);
  EXPECT_EQ(master.lifecycle(), Lifecycle::kFault);
  EXPECT_THROW(master.Activate(), std::logic_error);
  master.Recover();
  master.Activate();
  EXPECT_EQ(master.lifecycle(), Lifecycle::kActive);
}

TEST(Master, LetsADeviceGoThatStatesImpossiblePhysics) {
  RecordingMaster master;
  master.stated.name = "odd";
  master.stated.period = 1e-12;
  EXPECT_THROW(master.Configure(), std::invalid_argument);
  EXPECT_TRUE(master.let_go);
  EXPECT_EQ(master.lifecycle(), Lifecycle::kUnconfigured);
  master.stated.period = 1e-3;
  master.stated.angular.damping = -2;
  try {
    master.Configure();
    FAIL();
  } catch (const std::invalid_argument& error) {
    EXPECT_STREQ(error.what(), "device 'odd'.angular.damping = -2, must be in [0, 1000000]");
  }
}

TEST(Master, SaysWhichStepOfTheLifeCycleIsMissing) {
  RecordingMaster master;
  try {
    master.Activate();
    FAIL() << "activated without a device";
  } catch (const std::logic_error& error) {
    EXPECT_STREQ(error.what(), "master '' is unconfigured: Activate needs it inactive");
  }
}

}  // namespace
}  // namespace vmech
