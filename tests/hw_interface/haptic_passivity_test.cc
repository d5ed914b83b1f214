/// A thousand random sessions, most of them absurd, on the simulated arm: whatever the mechanism,
/// the gains, the operator, the delay and what gets lost, the observed energy stays above its
/// bound, forces below the clamp, and every number is one.
///
/// VMECH_PASSIVITY_SECONDS sets how long each lasts; 60 takes the better part of an hour.

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <random>

#include "hw_interface/tick_input.h"
#include "support/examples.h"
#include "vmech/hw_interface/loop/runner.h"
#include "vmech/hw_interface/masters/simulated_master.h"
#include "vmech/hw_interface/rendering/coupled_tick.h"
#include "vmech/hw_interface/rendering/coupling_choice.h"
#include "vmech/hw_interface/rendering/mechanism_tick.h"

namespace vmech::haptic_passivity_test {
namespace {

constexpr int kSessions = 1000;
constexpr int kShards = 20;
constexpr double kPeriod = 1e-3;

double Seconds() {
  const char* text = std::getenv("VMECH_PASSIVITY_SECONDS");
  return text ? std::atof(text) : 0.25;
}

/// Oversleeps by one to three slots, one time in ten.
class LossyClock : public FreeRunningClock {
 public:
  explicit LossyClock(unsigned seed) : random_(seed) {}
  void SleepUntil(std::int64_t time_ns) noexcept override {
    const auto lot = random_() % 30;
    FreeRunningClock::SleepUntil(time_ns + (lot < 3 ? 1'000'000 * (1 + lot) : 0));
  }

 private:
  std::mt19937 random_;
};

double PowerOfTen(Random* random, double low, double high) {
  return std::pow(10, random->Between(low, high));
}

SimulatedMasterOptions RandomArm(Random* random, unsigned seed) {
  SimulatedMasterOptions arm;
  arm.hand = ImpedanceOf(static_cast<Grip>(seed / 7 % 4));
  arm.delay_periods = static_cast<int>(seed / 28 % 4);
  arm.lost_share = 0.1;
  arm.seed = seed;
  const Posed X_DH = ArmModel(std::make_shared<const ArmDescription>(SarcosMasterArm())).X_DH();
  arm.motion = Wander(X_DH, random->Between(0, 0.1), random->Between(0, 0.4), seed);
  return arm;
}

/// Gains from a hundredth to a thousand times of what suits the device.
std::unique_ptr<Tick> RandomTick(Random* random, const KinematicTree& tree, int grasp,
                                 const VectorXd& q, const DeviceInfo& device) {
  const CouplingChoice choice =
      ChooseCoupling(tree, GraspFrameOf(tree, grasp), q, device, 2 * kPeriod);
  const double stiffer = PowerOfTen(random, -2, 3), dampened = PowerOfTen(random, -2, 3);
  if (random->Between(0, 1) < 0.7) {
    CoupledTickOptions options;
    options.coupling = choice.coupling;
    options.scale = PowerOfTen(random, -2, 0.5);
    Vector6d &K = options.coupling.stiffness, &B = options.coupling.damping;
    K = (stiffer * K).cwiseMin(1e9 * options.scale);
    B = (dampened * B).cwiseMin(1e7 * options.scale);
    return std::make_unique<CoupledTick>(tree, grasp, q, kPeriod, options);
  }
  MechanismTickOptions options;
  options.law.kind = static_cast<ContactKind>(static_cast<int>(random->Between(0, 2.999)));
  options.law.stiffness = (stiffer * choice.coupling.stiffness).cwiseMin(1e7);
  options.law.damping = (dampened * choice.coupling.damping).cwiseMin(1e5);
  options.inertia = random->Between(0, 1);
  return std::make_unique<MechanismTick>(tree, grasp, q, device, options);
}

void RunSession(unsigned seed) {
  const std::vector<std::string> names{"crank", "two-link-arm", "slider-crank", "four-bar",
                                       "rssr",  "bennett",      "stewart-gough"};
  Random random(seed);
  const Mechanism mechanism = Example(names[seed % names.size()]);
  const KinematicTree tree = BuildKinematicTree(mechanism);
  const VectorXd q = ClosedStart(tree);
  SimulatedMaster master(RandomArm(&random, seed));
  master.Configure();
  const int grasp = FindGrasp(mechanism, "handle");
  const std::unique_ptr<Tick> tick = RandomTick(&random, tree, grasp, q, master.info());
  RunnerOptions options;
  options.seconds = Seconds();
  options.record = true;
  options.realtime.reset();
  if (seed % 2 == 0) options.safety = CouplingChoice{{}, 1, 1, 0, 0.02, master.info()}.Safety();
  options.safety.soft_start = random.Between(0, 0.2);
  LossyClock clock(seed);
  Runner runner(options, &master, tick.get(), &clock);
  const RunSummary summary = runner.Run();

  const double bound = SafetyFilter(options.safety, master.info()).EnergyBound();
  EXPECT_GE(summary.least_energy, -bound) << seed;
  const DeviceInfo& device = master.info();
  for (const TickRecord& record : runner.Kept().ticks) {
    ASSERT_TRUE(record.sent_F_Ho_D.allFinite() && record.state.X_DH.p.allFinite() &&
                std::isfinite(record.energy))
        << seed;
    ASSERT_LE(record.sent_F_Ho_D.head<3>().norm(), device.linear.peak * (1 + 1e-9)) << seed;
    ASSERT_LE(record.sent_F_Ho_D.tail<3>().norm(), device.angular.peak * (1 + 1e-9)) << seed;
  }
}

class HapticPassivity : public testing::TestWithParam<int> {};

TEST_P(HapticPassivity, HoldsWhateverTheSession) {
  for (int seed = GetParam(); seed < kSessions; seed += kShards) RunSession(seed);
}

INSTANTIATE_TEST_SUITE_P(Shards, HapticPassivity, testing::Range(0, kShards));

}  // namespace
}  // namespace vmech::haptic_passivity_test
