// The sanitizers bring an allocator of theirs.
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <memory>

#include "hw_interface/held_tick.h"
#include "hw_interface/point_master.h"
#include "hw_interface/tick_input.h"
#include "support/count_allocations.h"
#include "support/examples.h"
#include "vmech/hw_interface/loop/runner.h"
#include "vmech/hw_interface/masters/simulated_master.h"
#include "vmech/hw_interface/masters/workspace_master.h"
#include "vmech/hw_interface/probing/probe_ticks.h"
#include "vmech/hw_interface/rendering/coupled_tick.h"

namespace vmech::allocation_test {
namespace {

/// A spring that notes how much had been allocated by its first ticks and by its last.
class CountingTick : public Tick {
 public:
  std::vector<std::string> ChannelNames() const override { return {}; }
  Posed GraspFrame() const noexcept override { return {}; }
  void Reset() noexcept override {}
  TickOutput Step(const TickInput& input, std::span<double>) noexcept override {
    if (++ticks == 10) at_first = allocations;
    at_last = allocations;
    TickOutput out;
    out.F_Ho_W.head<3>() = -100 * input.X_WH.p;
    return out;
  }
  int ticks = 0;
  long at_first = 0, at_last = 0;
};

/// The simulated arm included: a hand that wanders, torques of a redundant arm, lost commands.
TEST(Runner, AllocatesNothingIn10000Ticks) {
  SimulatedMasterOptions options;
  options.motion = Wander(
      ArmModel(std::make_shared<const ArmDescription>(SarcosMasterArm())).X_DH(), 0.05, 0.2, 3);
  options.lost_share = 0.1;
  options.delay_periods = 1;
  SimulatedMaster master(options);
  master.Configure();
  CountingTick tick;
  RunnerOptions run;
  run.seconds = 10;
  run.record = true;
  run.realtime.reset();
  FreeRunningClock clock;
  const RunSummary summary = Runner(run, &master, &tick, &clock).Run();
  EXPECT_EQ(summary.status, RunStatus::kFinished) << summary.FullReport();
  EXPECT_EQ(tick.ticks, 10'000);
  EXPECT_EQ(tick.at_last - tick.at_first, 0);
}

/// Scale, clutch and the tick that shakes a handle, at a point that a hand may hold.
TEST(WorkspaceMaster, AllocatesNothingWhileItIsShaken) {
  WorkspaceOptions options;
  options.motion_scale = 2;
  options.clutch = 0;
  WorkspaceMaster master(options, std::make_unique<PointMaster>(PointOptions{}));
  master.Configure();
  master.Activate();
  ShakeTick tick({}, 1e-3);
  std::array<double, 2> channels{};
  MasterState state;
  const long before = allocations;
  for (std::int64_t k = 0; k < 5000; ++k) {
    ASSERT_EQ(master.Read(k * 1'000'000, &state), IoStatus::kOk);
    TickInput input;
    input.fresh = true;
    input.elapsed = 1e-3;
    input.state = &state;
    MasterCommand command;
    command.mode = CommandMode::kWrench;
    command.F_Ho_D = tick.Step(input, channels).F_Ho_W;
    ASSERT_EQ(master.Write(command), IoStatus::kOk);
  }
  EXPECT_EQ(allocations - before, 0);
}

TEST(CoupledTick, AllocatesNothingWhileItsHandLeadsItSlipsAndLetsGo) {
  for (const char* name :
       {"crank", "two-link-arm", "slider-crank", "four-bar", "rssr", "bennett", "stewart-gough"}) {
    const KinematicTree tree = BuildKinematicTree(Example(name));
    const VectorXd q = ClosedStart(tree);
    CoupledTickOptions options;
    options.coupling.stiffness.setConstant(1e4);
    options.coupling.damping.setConstant(50);
    options.coupling.max_force = 50;
    CoupledTick tick(tree, FindGrasp(tree.mechanism, "handle"), q, 1e-3, options);
    std::vector<double> channels(tick.ChannelNames().size());
    TickInput input = FreshInput(tick.GraspFrame(), 1e-3);
    const long before = allocations;
    for (int k = 0; k < 2000; ++k) {
      input.X_WH.p.x() += 1e-4 * std::sin(0.01 * k);
      input.held = k % 500 < 400;
      if (k % 500 == 0) tick.GraspAt(input.X_WH);
      ASSERT_NE(tick.Step(input, channels).status, TickStatus::kFailed);
    }
    EXPECT_EQ(allocations - before, 0) << name;
  }
}

/// Two hands, of which the second comes late, lets go and comes back.
TEST(CoupledTick, AllocatesNothingInTwoHands) {
  for (const char* name : {"two-link-arm", "four-bar", "stewart-gough"}) {
    Mechanism mechanism = Example(name);
    const int handle = FindGrasp(mechanism, "handle");
    mechanism.grasps.push_back(mechanism.grasps[handle]);
    mechanism.grasps.back().name = "second";
    mechanism.grasps.back().X_LG.p.x() -= 0.1;
    const KinematicTree tree = BuildKinematicTree(mechanism);
    CoupledTickOptions options;
    options.coupling.stiffness.setConstant(1e4);
    options.coupling.damping.setConstant(50);
    options.coupling.max_force = 50;
    const int second = static_cast<int>(mechanism.grasps.size()) - 1;
    const std::array hands{CoupledHand{handle, options.coupling},
                           CoupledHand{second, options.coupling}};
    CoupledTick tick(tree, hands, ClosedStart(tree), 1e-3, options);
    std::vector<double> channels(tick.ChannelNames().size());
    std::array inputs{FreshInput(tick.HeldFrame(0), 1e-3), FreshInput(tick.HeldFrame(1), 1e-3)};
    std::array<TickOutput, 2> outputs;
    TickPicture picture;
    picture.others.resize(1);
    tick.Show(&picture);
    const long before = allocations;
    for (int k = 0; k < 2000; ++k) {
      for (TickInput& input : inputs) input.X_WH.p.x() += 1e-4 * std::sin(0.01 * k);
      inputs[1].held = k % 500 > 100;
      tick.StepHands(inputs, outputs, channels);
      tick.Show(&picture);
      ASSERT_NE(outputs[0].status, TickStatus::kFailed);
    }
    EXPECT_EQ(allocations - before, 0) << name;
  }
}

class EveryTick : public testing::TestWithParam<std::tuple<std::string, Architecture>> {};

/// A hand that pulls on the constraints all the time: rescues, limits and closing steps included.
TEST_P(EveryTick, AllocatesNothingIn100000Ticks) {
  const auto& [example, architecture] = GetParam();
  HeldTick tick(example, architecture);
  tick.Full();
  const long before = allocations;
  for (int k = 0; k < 100'000; ++k) tick.Full();
  EXPECT_EQ(allocations - before, 0);
  // The paper's way is not passive against a hand that no force slows down.
  if (architecture == Architecture::kCoupled) {
    EXPECT_EQ(tick.force_off(), ForceOff::kNone);
  }
}

INSTANTIATE_TEST_SUITE_P(
    Examples, EveryTick,
    testing::Combine(testing::Values("crank", "two-link-arm", "slider-crank", "four-bar", "rssr",
                                     "bennett", "stewart-gough"),
                     testing::Values(Architecture::kCoupled, Architecture::kPaper)),
    [](const auto& info) {
      const bool coupled = std::get<1>(info.param) == Architecture::kCoupled;
      return TestName(std::get<0>(info.param)) + (coupled ? "Coupled" : "Paper");
    });

}  // namespace
}  // namespace vmech::allocation_test

#endif
