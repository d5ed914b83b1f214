#include "vmech/hw_interface/masters/master.h"

#include <stdexcept>
#include <string>

#include <gtest/gtest.h>

namespace vmech::master_test {
namespace {

/// A driver that remembers what reached it.
class RecordingMaster : public Master {
 public:
  ~RecordingMaster() override { Shutdown(); }
  MasterCommand last;
  IoStatus next_read = IoStatus::kOk;
  DeviceInfo stated;
  bool let_go = false;
  std::uint32_t senses = kSensesPose | kSensesJoints, valid = senses;
  double x = 0;

 private:
  DeviceInfo OnConfigure() override {
    stated.takes_wrench = true;
    stated.senses = senses;
    return stated;
  }
  void OnShutdown() noexcept override { let_go = true; }
  IoStatus OnRead(std::int64_t, MasterState* state) noexcept override {
    state->sequence++;
    state->valid = valid;
    state->X_DH.p.x() = x;
    state->dead_man = true;
    return next_read;
  }
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

TEST(Master, TakesASampleWithoutAPoseForNone) {
  RecordingMaster master;
  master.Configure();
  master.x = 1;
  MasterState state;
  EXPECT_EQ(master.Read(0, &state), IoStatus::kOk);
  for (const std::uint32_t valid : {0u, std::uint32_t{kSensesPose}, std::uint32_t{kSensesJoints}}) {
    master.valid = valid;
    master.x = 2;
    const std::uint64_t sequence = state.sequence;
    EXPECT_EQ(master.Read(1'000'000, &state), IoStatus::kNoNewData) << valid;
    EXPECT_EQ(state.X_DH.p.x(), 1);
    EXPECT_EQ(state.sequence, sequence);
    EXPECT_EQ(state.host_time_ns, 1'000'000);
    EXPECT_TRUE(state.dead_man);
  }
  master.valid = master.senses;
  EXPECT_EQ(master.Read(2'000'000, &state), IoStatus::kOk);
  EXPECT_EQ(state.X_DH.p.x(), 2);
}

TEST(Master, RefusesADeviceThatSensesNoPose) {
  RecordingMaster master;
  master.stated.name = "blind";
  master.senses = kSensesButtons;
  try {
    master.Configure();
    FAIL();
  } catch (const std::logic_error& error) {
    EXPECT_NE(std::string(error.what()).find("device 'blind' states that it senses no pose"),
              std::string::npos);
  }
  EXPECT_TRUE(master.let_go);
}

TEST(Master, CountsPeriodsByTheSequenceAsFarAsTheClockAllows) {
  MasterState earlier, later;
  earlier.sequence = 10;
  later.sequence = 14;
  later.host_time_ns = 4'000'000;
  EXPECT_EQ(PeriodsBetween(earlier, later, 1e-3), 4);
  later.sequence = 1'000'000;
  EXPECT_EQ(PeriodsBetween(earlier, later, 1e-3), 12);
  later.sequence = 5;  // a device that starts anew
  EXPECT_EQ(PeriodsBetween(earlier, later, 1e-3), 12);
  EXPECT_EQ(PeriodsBetween(earlier, earlier, 1e-3), 1);
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
}  // namespace vmech::master_test
