#include "vmech/hw_interface/safety/safety_filter.h"

#include <gtest/gtest.h>

#include <limits>

#include "hw_interface/point_master.h"
#include "support/examples.h"

namespace vmech::safety_filter_test {
namespace {

constexpr double kPeriod = 1e-3;

DeviceInfo SmallDevice() {
  DeviceInfo info;
  info.name = "small";
  info.linear = {0.5, 0, 0, 0, 20, 2};
  info.angular = {0.005, 0, 0, 0, 1, 20};
  return info;
}

/// No ramp, no slew, no trip: one stage at a time is then switched on.
SafetyOptions Bare() {
  SafetyOptions options;
  options.soft_start = 0;
  options.force_slew = 1e7;
  options.moment_slew = 1e6;
  options.passivity.enabled = false;
  return options;
}

class Chain : public testing::Test {
 protected:
  SafetyOutput Apply(SafetyFilter* filter, const Vector6d& F) {
    ++state_.sequence;
    return filter->Apply({lifecycle_, io_, &state_, F, 0});
  }
  Chain() { state_.dead_man = true; }

  MasterState state_;
  Lifecycle lifecycle_ = Lifecycle::kActive;
  IoStatus io_ = IoStatus::kOk;
  Vector6d push_ = Vector6d::Unit(0) * 3;
};

TEST_F(Chain, LetsASoundWrenchPass) {
  SafetyFilter filter(Bare(), SmallDevice());
  const SafetyOutput out = Apply(&filter, push_);
  EXPECT_EQ(out.F_Ho_D, push_);
  EXPECT_EQ(out.off, ForceOff::kNone);
  EXPECT_EQ(out.stages, 0u);
}

TEST_F(Chain, GivesNothingUnlessActive) {
  SafetyFilter filter(Bare(), SmallDevice());
  lifecycle_ = Lifecycle::kInactive;
  const SafetyOutput out = Apply(&filter, push_);
  EXPECT_EQ(out.off, ForceOff::kNotActive);
  EXPECT_EQ(out.F_Ho_D, Vector6d::Zero());
}

TEST_F(Chain, LatchesWhatIsNotANumber) {
  SafetyFilter filter(Bare(), SmallDevice());
  Vector6d broken = push_;
  broken[4] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(Apply(&filter, broken).off, ForceOff::kNonFinite);
  EXPECT_EQ(Apply(&filter, push_).off, ForceOff::kNonFinite);
  filter.Unlatch();
  EXPECT_EQ(Apply(&filter, push_).off, ForceOff::kNone);
  EXPECT_EQ(filter.counters().trips, 1u);
}

TEST_F(Chain, RefusesAPoseThatIsNotANumber) {
  SafetyFilter filter(Bare(), SmallDevice());
  state_.X_DH.p.z() = std::numeric_limits<double>::infinity();
  EXPECT_EQ(Apply(&filter, push_).off, ForceOff::kNonFinite);
}

TEST_F(Chain, EmergencyStopStaysUntilRearmedAndReleased) {
  SafetyFilter filter(Bare(), SmallDevice());
  state_.emergency_stop = true;
  EXPECT_EQ(Apply(&filter, push_).off, ForceOff::kEmergencyStop);
  filter.Unlatch();
  EXPECT_EQ(Apply(&filter, push_).off, ForceOff::kEmergencyStop);
  state_.emergency_stop = false;
  EXPECT_EQ(Apply(&filter, push_).off, ForceOff::kEmergencyStop);
  filter.Unlatch();
  EXPECT_EQ(Apply(&filter, push_).off, ForceOff::kNone);
}

TEST_F(Chain, DeadManComesBackWithASoftStart) {
  SafetyOptions options = Bare();
  options.soft_start = 0.1;
  SafetyFilter filter(options, SmallDevice());
  for (int k = 0; k < 200; ++k) EXPECT_EQ(Apply(&filter, push_).off, ForceOff::kNone);
  EXPECT_EQ(Apply(&filter, push_).F_Ho_D, push_);
  state_.dead_man = false;
  EXPECT_EQ(Apply(&filter, push_).off, ForceOff::kDeadMan);
  state_.dead_man = true;
  EXPECT_EQ(Apply(&filter, push_).F_Ho_D, Vector6d::Zero());
  for (int k = 0; k < 49; ++k) EXPECT_EQ(Apply(&filter, push_).stages, kRamped);
  EXPECT_NEAR(Apply(&filter, push_).F_Ho_D[0], 1.5, 1e-9);
}

TEST_F(Chain, HoldsForAFewMissingSamplesOnly) {
  SafetyFilter filter(Bare(), SmallDevice());
  EXPECT_EQ(Apply(&filter, push_).off, ForceOff::kNone);
  io_ = IoStatus::kNoNewData;
  for (int k = 0; k < 5; ++k) {
    EXPECT_EQ(filter.Apply({lifecycle_, io_, &state_, push_, 0}).off, ForceOff::kNone);
  }
  EXPECT_EQ(filter.Apply({lifecycle_, io_, &state_, push_, 0}).off, ForceOff::kStale);
  io_ = IoStatus::kOk;
  EXPECT_EQ(Apply(&filter, push_).off, ForceOff::kNone);
}

TEST_F(Chain, LatchesALostLink) {
  SafetyFilter filter(Bare(), SmallDevice());
  io_ = IoStatus::kLinkLost;
  EXPECT_EQ(Apply(&filter, push_).off, ForceOff::kLinkLost);
  io_ = IoStatus::kOk;
  EXPECT_EQ(Apply(&filter, push_).off, ForceOff::kLinkLost);
}

TEST_F(Chain, ClampKeepsTheDirectionOfTheWholeWrench) {
  SafetyFilter filter(Bare(), SmallDevice());
  Vector6d F;
  F << 0, 30, 40, 0, 0, 0.5;
  const SafetyOutput out = Apply(&filter, F);
  EXPECT_LT((out.F_Ho_D - 0.4 * F).norm(), 1e-12);
  EXPECT_EQ(out.stages, kClamped);
  F << 0, 3, 4, 0, 0, 4;
  EXPECT_LT((Apply(&filter, F).F_Ho_D - 0.25 * F).norm(), 1e-12);
}

TEST_F(Chain, SlewLimitsTheChangePerTick) {
  SafetyOptions options = Bare();
  options.force_slew = 1000;
  SafetyFilter filter(options, SmallDevice());
  EXPECT_NEAR(Apply(&filter, push_).F_Ho_D[0], 1, 1e-12);
  EXPECT_NEAR(Apply(&filter, push_).F_Ho_D[0], 2, 1e-12);
  EXPECT_NEAR(Apply(&filter, push_).F_Ho_D[0], 3, 1e-12);
  EXPECT_NEAR(Apply(&filter, -push_).F_Ho_D[0], 2, 1e-12);
}

TEST_F(Chain, TripsOnSpeedButNotOnOneEncoderStep) {
  SafetyFilter filter(Bare(), SmallDevice());
  EXPECT_EQ(Apply(&filter, push_).off, ForceOff::kNone);
  state_.X_DH.p.x() += 5e-3;  // 5 m/s for one sample
  EXPECT_EQ(Apply(&filter, push_).off, ForceOff::kNone);
  ForceOff off = ForceOff::kNone;
  for (int k = 0; k < 10; ++k) {
    state_.X_DH.p.x() += 3e-3;  // 3 m/s, at most 2
    off = Apply(&filter, push_).off;
  }
  EXPECT_EQ(off, ForceOff::kSpeed);
}

/// A spring of 1 N/mm to the device, held anew after every gap; 20 N at most.
Vector6d SpringTo(const Vector3d& p) {
  return Stacked<double>(-1000 * p, Vector3d::Zero());
}

/// Gaps of 1 to 50 samples, and then the hand is somewhere else: a metre away trips, five
/// millimetres are caught up with softly.
TEST_F(Chain, AGapFollowedByALeapIsNoBlow) {
  for (const double leap : {5e-3, 1.0}) {
    for (int gap = 1; gap <= 50; ++gap) {
      SafetyOptions options;
      options.soft_start = 0.5;
      options.force_slew = 5e4;
      SafetyFilter filter(options, SmallDevice());
      MasterState state;
      state.dead_man = true;
      Vector6d last = Vector6d::Zero();
      ForceOff off = ForceOff::kNone;
      for (int k = 0; k < 1500; ++k) {
        const bool missing = k >= 600 && k < 600 + gap;
        state.host_time_ns = k * 1'000'000LL;
        if (!missing) {
          state.sequence = k + 1;
          state.X_DH.p.x() = k >= 600 + gap ? leap : 0;
        }
        const IoStatus io = missing ? IoStatus::kNoNewData : IoStatus::kOk;
        const SafetyOutput out = filter.Apply({lifecycle_, io, &state, SpringTo(state.X_DH.p), 0});
        if (out.off == ForceOff::kNone) {
          EXPECT_LE((out.F_Ho_D - last).norm(), 1 + 1e-9) << leap << " m after " << gap;
        }
        last = out.F_Ho_D;
        off = out.off;
      }
      if (leap == 1.0) {
        EXPECT_EQ(off, ForceOff::kSpeed) << gap;
      } else if (gap > 2) {  // nearer in time, 5 mm are more than the 2 m/s of the device
        EXPECT_EQ(off, ForceOff::kNone) << gap;
        EXPECT_NEAR(last[0], -5, 0.1) << gap;
      }
    }
  }
}

/// A sequence number that runs away from the clock does not make a leap slow.
TEST_F(Chain, ALeapIsJudgedByTheHostsClockToo) {
  SafetyFilter filter(Bare(), SmallDevice());
  EXPECT_EQ(Apply(&filter, push_).off, ForceOff::kNone);
  state_.sequence += 1'000'000;
  state_.host_time_ns += 1'000'000;
  state_.X_DH.p.x() += 1;
  EXPECT_EQ(Apply(&filter, push_).off, ForceOff::kSpeed);
}

TEST_F(Chain, ADeviceThatRepeatsItsSampleGoesStale) {
  SafetyFilter filter(Bare(), SmallDevice());
  EXPECT_EQ(Apply(&filter, push_).off, ForceOff::kNone);
  for (int k = 0; k < 5; ++k) {
    EXPECT_EQ(filter.Apply({lifecycle_, io_, &state_, push_, 0}).off, ForceOff::kNone);
  }
  EXPECT_EQ(filter.Apply({lifecycle_, io_, &state_, push_, 0}).off, ForceOff::kStale);
}

TEST_F(Chain, DropsTheMomentsThatADeviceCannotExert) {
  DeviceInfo device = SmallDevice();
  device.angular.peak = 0;
  SafetyFilter filter(Bare(), device);
  Vector6d F;
  F << 1, 2, 3, 0.1, 0.2, 0.3;
  const SafetyOutput out = Apply(&filter, F);
  EXPECT_EQ(out.F_Ho_D.head<3>(), F.head<3>());
  EXPECT_EQ(out.F_Ho_D.tail<3>(), Vector3d::Zero());
}

/// The hand turns a handle that has no motors for that: passivity damps what can be damped, and the
/// force against the hand stays.
TEST_F(Chain, PassivityLeavesTheForceOfAHandleThatTurnsFreely) {
  DeviceInfo info = SmallDevice();
  info.angular = {};
  SafetyOptions options = Bare();
  options.passivity.enabled = true;
  options.energy_trip = 100;
  SafetyFilter filter(options, info);
  const Vector6d against = Vector6d::Unit(0) * -3;
  SafetyOutput out;
  for (int k = 0; k < 20; ++k) {
    ++state_.sequence;
    state_.X_DH.p.x() = 1e-4 * k;
    state_.X_DH.R = Eigen::AngleAxisd(2e-3 * k, Vector3d::UnitZ()).toRotationMatrix();
    // More is stored than the hand gives.
    out = filter.Apply({lifecycle_, io_, &state_, against, 5e-4 * k});
  }
  EXPECT_LT(out.energy, 0);
  EXPECT_TRUE(out.stages & kDamped);
  EXPECT_LE(out.F_Ho_D[0], -2.5);
  EXPECT_EQ(out.F_Ho_D.tail<3>(), Vector3d::Zero());
}

TEST_F(Chain, KeepsForceAndMomentWithinTheRoomOfThePosture) {
  SafetyFilter filter(Bare(), SmallDevice());
  Vector6d F;
  F << 0, 6, 8, 0, 0, 0.5;
  ++state_.sequence;
  // 10 N of 10 N and 0.5 N m of 1 N m, from the same motors: one and a half times what they have.
  const SafetyOutput out = filter.Apply({lifecycle_, io_, &state_, F, 0, WrenchLimit{10, 1, true}});
  EXPECT_LT((out.F_Ho_D - F / 1.5).norm(), 1e-12);
  EXPECT_EQ(out.stages, kClamped);
}

TEST_F(Chain, TripsWhenItGivesEnergyForNothing) {
  SafetyOptions options = Bare();
  options.energy_trip = 0.1;
  SafetyFilter filter(options, SmallDevice());
  int ticks = 0;
  while (Apply(&filter, push_).off == ForceOff::kNone && ticks < 1000) {
    state_.X_DH.p.x() += 1e-3;  // 3 N along 1 mm: 3 mJ a tick
    ++ticks;
  }
  EXPECT_EQ(filter.latched(), ForceOff::kEnergy);
  EXPECT_NEAR(ticks, 0.1 / 3e-3, 2);
}

TEST_F(Chain, MayGiveBackWhatTheMechanismStores) {
  SafetyFilter filter(Bare(), SmallDevice());
  double stored = 5;
  for (int k = 0; k < 1000; ++k) {
    ++state_.sequence;
    const SafetyOutput out = filter.Apply({lifecycle_, io_, &state_, push_, stored});
    ASSERT_EQ(out.off, ForceOff::kNone);
    EXPECT_NEAR(out.energy, 0, 1e-9);
    state_.X_DH.p.x() += 1e-3;
    stored -= 3e-3;
  }
}

TEST(SafetyOptions, NameWhatIsOutOfRange) {
  SafetyOptions options;
  options.soft_start = -1;
  EXPECT_THROW(options.Validate(), std::invalid_argument);
  DeviceInfo nothing_stated;
  EXPECT_THROW(SafetyFilter(SafetyOptions{}, nothing_stated), std::invalid_argument);
}

/// A wall rendered through the filter. What came of it.
struct Outcome {
  double balance = 0;     // least energy received by the virtual side [J]
  double bound = 0;       // it may not fall below minus this
  double peak_force = 0;  // [N]
  double late_swing = 0;  // largest |x| of the last tenth [m]
  double speed = 0;       // fastest [m/s]
  bool finite = true;
  ForceOff latched = ForceOff::kNone;
};

Outcome Render(const PointOptions& device, const Wall& wall, const SafetyOptions& safety,
               double seconds, double start = 1e-3, bool tells_storage = false) {
  PointMaster master(device);
  master.Configure();
  master.Activate();
  master.x[0] = start;
  SafetyFilter filter(safety, master.info());
  Outcome outcome;
  outcome.bound = filter.EnergyBound();
  MasterState state, last;
  MasterCommand command;
  command.mode = CommandMode::kWrench;
  const auto ticks = std::llround(seconds / kPeriod);
  for (std::int64_t k = 0; k < ticks; ++k) {
    const std::int64_t now = k * 1'000'000;
    const IoStatus io = master.Read(now, &state);
    if (k == 0) last = state;
    const Vector6d F = wall.Wrench(state, last, kPeriod);
    const SafetyOutput out = filter.Apply(
        {master.lifecycle(), io, &state, F, tells_storage ? wall.StoredEnergy(state) : 0});
    last = state;
    command.sequence = out.sequence;
    command.F_Ho_D = out.F_Ho_D;
    command.valid_until_ns = now + 5'000'000;
    EXPECT_EQ(master.Write(command), IoStatus::kOk);
    outcome.finite &= state.X_DH.p.allFinite() && out.F_Ho_D.allFinite();
    outcome.peak_force = std::max(outcome.peak_force, out.F_Ho_D.head<3>().norm());
    outcome.speed = std::max(outcome.speed, std::abs(master.v[0]));
    if (k >= ticks * 9 / 10) {
      outcome.late_swing = std::max(outcome.late_swing, std::abs(state.X_DH.p.x()));
    }
  }
  outcome.balance = master.least_balance;
  outcome.latched = filter.latched();
  return outcome;
}

TEST(Passivity, ControllerCalmsAWallThatWouldSwingUp) {
  const PointOptions device;  // stable up to 4000 N/m
  const Wall wall{8000, 0};
  SafetyOptions with = Bare(), without = Bare();
  with.passivity.enabled = true;
  without.energy_trip = 100;
  without.max_speed = with.max_speed = 100;
  EXPECT_GT(Render(device, wall, without, 3).late_swing, 1e-3);
  const Outcome calm = Render(device, wall, with, 3);
  EXPECT_EQ(calm.latched, ForceOff::kNone);
  EXPECT_LT(calm.late_swing, 1e-3);
}

TEST(Passivity, ControllerLeavesASoundWallAlone) {
  const PointOptions device;
  SafetyOptions safety = Bare();
  safety.passivity.enabled = true;
  SafetyOptions observe_only = Bare();
  const Wall wall{1000, 0};
  EXPECT_NEAR(Render(device, wall, safety, 0.2, 1e-3, true).late_swing,
              Render(device, wall, observe_only, 0.2, 1e-3, true).late_swing, 1e-5);
}

PointOptions RandomDevice(Random* random, unsigned seed) {
  PointOptions device;
  device.mass = std::pow(10, random->Between(-1.3, 0.3));
  device.damping = random->Between(0, 5);
  device.inertia = 0.01 * device.mass;
  device.angular_damping = 0.01 * device.damping;
  device.delay_periods = static_cast<int>(random->Between(0, 3.999));
  device.lost_share = 0.1;
  device.seed = seed;
  device.hand_stiffness = std::pow(10, random->Between(0, 3));
  device.hand_damping = 0.1 * std::sqrt(device.hand_stiffness * device.mass);
  device.reach = random->Between(0, 0.1);
  device.hertz = random->Between(0.2, 3);
  device.senses_wrench = seed % 2 == 0;
  return device;
}

/// 1000 devices, hands and walls, most of them absurd.
TEST(Passivity, EnergyStaysAboveItsBoundWhateverTheGains) {
  Random random(17);
  int tripped = 0;
  for (int run = 0; run < 1000; ++run) {
    const PointOptions device = RandomDevice(&random, run);
    const Wall wall{std::pow(10, random.Between(1, 6)), random.Between(-5, 100)};
    const Outcome outcome = Render(device, wall, SafetyOptions{}, 2, random.Between(-0.05, 0.05));
    ASSERT_TRUE(outcome.finite) << run;
    EXPECT_GE(outcome.balance, -outcome.bound) << run;
    EXPECT_LE(outcome.peak_force, 20 + 1e-9) << run;
    tripped += outcome.latched != ForceOff::kNone;
  }
  EXPECT_LE(tripped, 20);  // the controller holds nearly all of them without a trip
}

}  // namespace
}  // namespace vmech::safety_filter_test
