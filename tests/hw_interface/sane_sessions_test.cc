/// Random sessions that a user could hold: any example, any grip, encoders of 12 to 18 bits, 0.5 to
/// 4 kHz, with delays, losses and gaps, on the coupling that suits the device. None trips.
///
/// VMECH_SANE_SESSIONS sets how many there are, VMECH_SANE_SECONDS how long each lasts.

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <random>
#include <string>
#include <vector>

#include "hw_interface/tick_input.h"
#include "support/examples.h"
#include "vmech/hw_interface/loop/runner.h"
#include "vmech/hw_interface/masters/simulated_master.h"
#include "vmech/hw_interface/rendering/coupled_tick.h"
#include "vmech/hw_interface/rendering/coupling_choice.h"

namespace vmech {
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
           std::to_string(static_cast<int>(grip)) + ", delay " + std::to_string(delay) +
           ", lost " + std::to_string(lost) + ", seed " + std::to_string(seed);
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
  if (getenv("DBG")) printf("K %g B %g scale %g ratio %g weight %g unseen %g\n", options.coupling.stiffness[0], options.coupling.damping[0], options.scale, choice.inertia_ratio, choice.weight, choice.unseen_work);
  RunnerOptions run;
  run.seconds = seconds;
  run.realtime.reset();
  run.safety = choice.Safety();
  FreeRunningClock clock;
  Runner runner(run, &master, &tick, &clock);
  RunSummary sum = runner.Run();
  if (getenv("DBG")) { Recording r = runner.Kept(); for (size_t k = 0; k < r.ticks.size(); ++k) { const TickRecord& t = r.ticks[k]; if (k + 400 > r.ticks.size() && (k % 8 == 0 || k + 12 > r.ticks.size())) printf("%4zu E %.4f w %.2f %.2f %.2f | %.3f %.3f %.3f  a %.2f m %.3f x %.5f %.5f %.5f off %.5f %.4f cf %.2f st %g q %.2f %.2f %.2f %.2f %.2f %.2f %.2f\n", k, t.energy, t.wanted_F_Ho_D[0], t.wanted_F_Ho_D[1], t.wanted_F_Ho_D[2], t.wanted_F_Ho_D[3], t.wanted_F_Ho_D[4], t.wanted_F_Ho_D[5], t.state.applied_F_Ho_D.head<3>().norm(), t.state.applied_F_Ho_D.tail<3>().norm(), t.state.X_DH.p.x(), t.state.X_DH.p.y(), t.state.X_DH.p.z(), t.channels[0], t.channels[1], t.channels[2], t.channels[3], t.state.q[0], t.state.q[1], t.state.q[2], t.state.q[3], t.state.q[4], t.state.q[5], t.state.q[6]); } }
  return sum;
}

class SaneSessions : public testing::TestWithParam<int> {};

TEST_P(SaneSessions, DoNotTrip) {
  const std::vector<std::string> examples = Playable();
  const auto count = static_cast<unsigned>(FromEnvironment("VMECH_SANE_SESSIONS", 200));
  const double seconds = FromEnvironment("VMECH_SANE_SECONDS", 1);
  for (unsigned seed = GetParam(); seed < count; seed += kShards) {
    SaneSession session = RandomSession(examples, seed);
    if (getenv("ONLY") && std::atoi(getenv("ONLY")) != (int)seed) continue;
    if (getenv("BITS")) session.bits = std::atoi(getenv("BITS"));
    if (getenv("RATE")) session.rate = std::atoi(getenv("RATE"));
    if (getenv("LOST")) session.lost = std::atof(getenv("LOST"));
    const RunSummary summary = Hold(session, seconds);
    EXPECT_EQ(summary.status, RunStatus::kFinished) << session.Words() << ": "
                                                    << NameOf(summary.cause) << (getenv("DBG") ? summary.FullReport() : "");
  }
}

INSTANTIATE_TEST_SUITE_P(Shards, SaneSessions, testing::Range(0, kShards));

}  // namespace
}  // namespace vmech
