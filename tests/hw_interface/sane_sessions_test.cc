/// Sessions that a user could hold. Every example on a device of three freedoms; and random ones:
/// any example, any grip, encoders of 12 to 18 bits, 0.5 to 4 kHz, with delays, losses and gaps, on
/// the coupling that suits the device. None trips.
///
/// VMECH_SANE_SESSIONS sets how many there are, VMECH_SANE_SECONDS how long each lasts.

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <random>
#include <string>
#include <vector>

#include "hw_interface/point_master.h"
#include "hw_interface/tick_input.h"
#include "support/examples.h"
#include "vmech/hw_interface/loop/runner.h"
#include "vmech/hw_interface/masters/simulated_master.h"
#include "vmech/hw_interface/rendering/coupled_tick.h"
#include "vmech/hw_interface/rendering/coupling_choice.h"

namespace vmech::sane_sessions_test {
namespace {

constexpr int kShards = 4;

double FromEnvironment(const char* name, double otherwise) {
  const char* text = std::getenv(name);
  return text ? std::atof(text) : otherwise;
}

/// Examples with a grasp and a freedom.
std::vector<std::string> Playable() {
  std::vector<std::string> names;
  for (const std::string& name : ExampleNames()) {
    if (!Example(name).grasps.empty() && name != "beam-on-three-supports") names.push_back(name);
  }
  return names;
}

struct SaneSession {
  std::string example;
  int bits = 16, delay = 0;
  double rate = 1000;
  Grip grip = Grip::kRelaxed;
  double lost = 0;
  unsigned seed = 1;

  std::string Words() const {
    return example + ", " + std::to_string(bits) + " bits, " + std::to_string(rate) + " Hz, grip " +
           std::to_string(static_cast<int>(grip)) + ", delay " + std::to_string(delay) + ", lost " +
           std::to_string(lost) + ", seed " + std::to_string(seed);
  }
};

SaneSession RandomSession(const std::vector<std::string>& examples, unsigned seed) {
  Random random(1000 + seed);
  SaneSession session;
  session.example = examples[seed % examples.size()];
  session.bits = 12 + static_cast<int>(random.Between(0, 6.999));
  session.rate = 500 * std::exp2(std::floor(random.Between(0, 3.999)));
  session.grip = static_cast<Grip>(static_cast<int>(random.Between(0, 3.999)));
  session.delay = static_cast<int>(random.Between(0, 1.999));
  session.lost = random.Between(0, 1) < 0.3 ? 0.02 : 0;
  session.seed = seed;
  return session;
}

RunSummary Hold(const SaneSession& session, double seconds) {
  const Mechanism mechanism = Example(session.example);
  const KinematicTree tree = BuildKinematicTree(mechanism);
  const VectorXd q = ClosedStart(tree);
  SimulatedMasterOptions arm;
  arm.period = 1 / session.rate;
  arm.encoder_bits = session.bits;
  arm.delay_periods = session.delay;
  arm.lost_share = session.lost;
  arm.seed = session.seed;
  arm.hand = ImpedanceOf(session.grip);
  arm.motion = Wander(ArmModel(std::make_shared<const ArmDescription>(SarcosMasterArm())).X_DH(),
                      0.05, 0.2, session.seed);
  SimulatedMaster master(arm);
  master.Configure();
  CoupledTickOptions options;
  options.smoothing = 2 * arm.period;
  const CouplingChoice choice =
      ChooseCoupling(tree, GraspFrameOf(tree, 0), q, master.info(), options.smoothing);
  options.coupling = choice.coupling;
  options.scale = choice.scale;
  CoupledTick tick(tree, 0, q, arm.period, options);
  RunnerOptions run;
  run.seconds = seconds;
  run.realtime.reset();
  run.safety = choice.Safety();
  FreeRunningClock clock;
  return Runner(run, &master, &tick, &clock).Run();
}

class SaneSessions : public testing::TestWithParam<int> {};

TEST_P(SaneSessions, HardlyEverTrip) {
  const std::vector<std::string> examples = Playable();
  const auto count = static_cast<unsigned>(FromEnvironment("VMECH_SANE_SESSIONS", 200));
  const double seconds = FromEnvironment("VMECH_SANE_SECONDS", 1);
  int sessions = 0, trips = 0;
  std::string told;
  for (unsigned seed = GetParam(); seed < count; seed += kShards) {
    const SaneSession session = RandomSession(examples, seed);
    const RunSummary summary = Hold(session, seconds);
    ++sessions;
    if (summary.status == RunStatus::kFinished) continue;
    ++trips;
    told += session.Words() + ": " + NameOf(summary.cause) + "\n";
  }
  EXPECT_LE(trips, sessions / 100) << told;
}

/// Three freedoms of 8 N, with steps of a hundredth of a millimetre, and a hand that swings by 2 cm
/// whatever the mechanism allows.
PointOptions SmallDevice(Grip grip) {
  PointOptions device;
  device.mass = 0.3;
  device.damping = 1;
  device.resolution = 1e-5;
  device.peak = 8;
  device.forces_alone = true;
  device.hand_stiffness = ImpedanceOf(grip).stiffness;
  device.hand_damping = ImpedanceOf(grip).damping;
  device.reach = 0.02;
  device.hertz = 0.6;
  return device;
}

/// The largest change of the force from one tick to the next [N]. No moment is ever wanted or sent.
double LargestStep(const Recording& recording) {
  double largest = 0;
  Vector3d before = Vector3d::Zero();
  for (const TickRecord& tick : recording.ticks) {
    EXPECT_EQ(tick.wanted_F_Ho_D.tail<3>().norm(), 0);
    EXPECT_EQ(tick.sent_F_Ho_D.tail<3>().norm(), 0);
    const Vector3d force = tick.sent_F_Ho_D.head<3>();
    largest = std::max(largest, (force - before).norm());
    before = force;
  }
  return largest;
}

std::vector<std::string> HeldBySmallDevices() {
  std::vector<std::string> names = Playable();
  for (const char* name : {"puma-560", "redundant-arm", "stewart-gough-sps"}) {
    names.emplace_back(name);
  }
  return names;
}

class SmallDevices : public testing::TestWithParam<std::string> {};

/// Scale 0: the one that suits the device.
void HoldAtAPoint(const KinematicTree& tree, Grip grip, double scale) {
  SCOPED_TRACE("grip " + std::to_string(static_cast<int>(grip)) + ", scale " +
               std::to_string(scale));
  const VectorXd q = ClosedStart(tree);
  PointMaster master(SmallDevice(grip));
  master.Configure();
  CoupledTickOptions options;
  const CouplingChoice choice =
      ChooseCoupling(tree, GraspFrameOf(tree, 0), q, master.info(), options.smoothing, scale);
  options.scale = choice.scale;
  options.coupling = choice.coupling;
  CoupledTick tick(tree, 0, q, master.info().period, options);
  RunnerOptions run;
  run.seconds = 3;
  run.realtime.reset();
  run.record = true;
  run.safety = choice.Safety();
  FreeRunningClock clock;
  Runner runner(run, &master, &tick, &clock);
  const RunSummary summary = runner.Run();
  EXPECT_EQ(summary.status, RunStatus::kFinished) << summary.FullReport();
  EXPECT_LE(summary.peak_force, 8 * (1 + 1e-9));
  if (grip != Grip::kAbsent) EXPECT_GT(summary.peak_force, 0.1);
  EXPECT_LT(LargestStep(runner.Kept()), 1);
}

TEST_P(SmallDevices, HoldEveryExampleAtAPointWithoutAJump) {
  Mechanism mechanism = Example(GetParam());
  mechanism.grasps[0].kind = GraspKind::kPoint;
  const KinematicTree tree = BuildKinematicTree(mechanism);
  for (const Grip grip : {Grip::kAbsent, Grip::kLight, Grip::kRelaxed, Grip::kFirm}) {
    for (const double scale : {0.0, 0.02}) HoldAtAPoint(tree, grip, scale);
  }
}

INSTANTIATE_TEST_SUITE_P(Examples, SmallDevices, testing::ValuesIn(HeldBySmallDevices()),
                         [](const auto& info) { return TestName(info.param); });

INSTANTIATE_TEST_SUITE_P(Shards, SaneSessions, testing::Range(0, kShards));

}  // namespace
}  // namespace vmech::sane_sessions_test
