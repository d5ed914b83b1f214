#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "hw_interface/point_master.h"
#include "hw_interface/tick_input.h"
#include "support/examples.h"
#include "support/temp_folder.h"
#include "vmech/base/linear_algebra/linear_algebra.h"
#include "vmech/hw_interface/audit/audit.h"
#include "vmech/hw_interface/audit/promise.h"
#include "vmech/hw_interface/audit/recorded_tree.h"
#include "vmech/hw_interface/loop/replay_master.h"
#include "vmech/hw_interface/loop/runner.h"
#include "vmech/hw_interface/recording/recording_file.h"
#include "vmech/hw_interface/rendering/coupled_tick.h"
#include "vmech/hw_interface/rendering/coupling_choice.h"
#include "vmech/kinematics/loops/assembled_mechanism.h"
#include "vmech/kinematics/loops/loops.h"
#include "vmech/kinematics/tree/forward_kinematics.h"

namespace vmech::two_hands_test {
namespace {

constexpr double kPeriod = 1e-3;

/// A point whose link fails, or that never sends anything.
class FailingMaster : public Master {
 public:
  explicit FailingMaster(const PointOptions& options) : point(options) {}
  ~FailingMaster() override { Shutdown(); }

  PointMaster point;
  std::int64_t fails_at_ns = std::numeric_limits<std::int64_t>::max();
  IoStatus fails_with = IoStatus::kLinkLost;
  bool stopped = false;  // its emergency stop is pressed then, instead

 private:
  DeviceInfo OnConfigure() override {
    point.Configure();
    return point.info();
  }
  void OnActivate() override { point.Activate(); }
  void OnDeactivate() noexcept override { point.Deactivate(); }
  IoStatus OnRead(std::int64_t now_ns, MasterState* state) noexcept override {
    if (now_ns >= fails_at_ns && !stopped) return fails_with;
    const IoStatus io = point.Read(now_ns, state);
    if (now_ns >= fails_at_ns) state->emergency_stop = true;
    return io;
  }
  IoStatus OnWrite(const MasterCommand& command) noexcept override { return point.Write(command); }
};

struct SessionSetup {
  std::string example = "four-bar";
  bool gravity = true;
  std::array<PointOptions, 2> points;
  double seconds = 2;
  int hands = 2;
};

PointOptions Hand(double stiffness, double reach, double hertz) {
  PointOptions options;
  options.hand_stiffness = stiffness;
  options.hand_damping = 10;
  options.reach = reach;
  options.hertz = hertz;
  return options;
}

/// With a second grasp: at the crank's pin, or at the platform's other side.
Mechanism InTwoHands(const std::string& example, bool gravity) {
  Mechanism mechanism = Example(example);
  if (!gravity) mechanism.gravity_W.setZero();
  const bool platform = example == "stewart-gough";
  Grasp first{"left", FindLink(mechanism, "coupler"), Posed{}, GraspKind::kPoint};
  Grasp second{"right", FindLink(mechanism, "crank"), Posed{}, GraspKind::kPoint};
  if (platform) first.link = second.link = FindLink(mechanism, "platform");
  if (example == "two-link-arm") {
    first.link = FindLink(mechanism, "forearm");
    second.link = FindLink(mechanism, "upper-arm");
  }
  first.X_LG.p = platform ? Vector3d(0.2, 0, 0.1) : Vector3d(0.3, 0, 0);
  second.X_LG.p = platform ? Vector3d(-0.2, 0, 0.1) : Vector3d(0.25, 0, 0);
  mechanism.grasps = {first, second};
  KinematicTree tree = BuildKinematicTree(mechanism);
  SetStarts(tree, ClosedStart(tree), &mechanism);
  return mechanism;
}

/// Two simulated hands on a mechanism.
class TwoHands {
 public:
  explicit TwoHands(const SessionSetup& setup)
      : setup_(setup),
        tree(BuildKinematicTree(InTwoHands(setup.example, setup.gravity))),
        masters{std::make_unique<FailingMaster>(setup.points[0]),
                std::make_unique<FailingMaster>(setup.points[1])} {
    for (const auto& master : masters) master->Configure();
  }

  RunSummary Run() { return RunWith({masters[0].get(), masters[1].get()}); }
  RunSummary Replay() {
    std::array<std::unique_ptr<ReplayMaster>, 2> replays;
    std::vector<Master*> devices;
    for (int i = 0; i < setup_.hands; ++i) {
      replays[i] = std::make_unique<ReplayMaster>(recording, ReplayKind::kSession, i);
      replays[i]->Configure();
      devices.push_back(replays[i].get());
    }
    return RunWith(devices);
  }
  /// Joint forces of the hands' wrenches along the free motions, at the end.
  VectorXd GeneralisedForces() const {
    const TickPicture& picture = recording.ticks.back().picture;
    TreeWorkspace<double> ws(tree);
    ForwardKinematics(tree, picture.q.data(), &ws);
    VectorXd tau = VectorXd::Zero(tree.nv);
    for (int i = 0; i < 2; ++i) {
      Matrix6Xd J(6, tree.nv);
      const GraspFrame grasp = GraspFrameOf(tree, i);
      GraspJacobian(tree, ws, grasp.node, grasp.X_BG, &J);
      tau += J.transpose() * picture.hand(i).dynamic;
    }
    LoopErrors(tree, &ws);
    LoopJacobian(tree, &ws);
    return FindNullSpace(DenseLoopJacobian(tree, ws), 1e-9).basis.transpose() * tau;
  }

 private:
  RunSummary RunWith(std::vector<Master*> devices) {
    devices.resize(static_cast<size_t>(setup_.hands));
    const VectorXd q = StartCoordinates(tree);
    CoupledTickOptions options;
    RunnerOptions run;
    std::vector<CoupledHand> coupled;
    std::vector<RunnerHand> hands;
    run.notes = {{"coupling", "virtual"}};
    for (int i = 0; i < setup_.hands; ++i) {
      const CouplingChoice choice =
          ChooseCoupling(tree, GraspFrameOf(tree, i), q, devices[i]->info(), options.smoothing);
      coupled.push_back({i, choice.coupling});
      hands.push_back({devices[i], choice.Safety(), {}});
      hands.back().safety.soft_start = 0.1;
      bounds[i] = SafetyFilter(hands.back().safety, devices[i]->info()).EnergyBound();
      run.notes.emplace_back(RecordingHeader::KeyOf("grasp", i), tree.mechanism.grasps[i].name);
      for (const auto& note : NotesOf({true, false, 1, 1, choice.coupling}, i)) {
        run.notes.push_back(note);
      }
    }
    run.mechanism = RecordedMechanismOf(tree);
    run.seconds = setup_.seconds;
    run.record = true;
    run.realtime.reset();
    CoupledTick tick(tree, coupled, q, kPeriod, options);
    FreeRunningClock clock;
    Runner runner(run, hands, &tick, &clock);
    const RunSummary summary = runner.Run();
    recording = runner.Kept();
    return summary;
  }

  SessionSetup setup_;

 public:
  KinematicTree tree;
  std::array<std::unique_ptr<FailingMaster>, 2> masters;
  std::array<double, 2> bounds{};
  Recording recording;
};

/// Both hands pull their handles back to where they were: away from each other.
SessionSetup PullingApart(const std::string& example) {
  SessionSetup setup;
  setup.example = example;
  setup.gravity = false;
  setup.seconds = 6;
  setup.points = {Hand(200, 0, 0), Hand(200, 0, 0)};
  for (PointOptions& point : setup.points) point.hand_damping = 80;  // it comes to rest
  return setup;
}
void PullApart(TwoHands* hands) {
  hands->masters[0]->point.x = {-0.02, -0.01, 0, 0};
  hands->masters[1]->point.x = {0.03, 0.01, 0, 0};
}

TEST(TwoHands, FeelEqualAndOppositeForcesOnAFreePlatform) {
  TwoHands hands(PullingApart("stewart-gough"));
  PullApart(&hands);
  const RunSummary summary = hands.Run();
  ASSERT_EQ(summary.status, RunStatus::kFinished) << summary.FullReport();
  const TickRecord& last = hands.recording.ticks.back();
  const Vector3d first = last.of_hand(0).sent_F_Ho_D.head<3>();
  const Vector3d second = last.of_hand(1).sent_F_Ho_D.head<3>();
  EXPECT_GT(first.norm(), 1);
  EXPECT_LT((first + second).norm(), 1e-3);
  const Vector3d apart = last.picture.hand(0).X_WG.p - last.picture.hand(1).X_WG.p;
  EXPECT_LT(apart.cross(first).norm(), 1e-3);
  EXPECT_LT(hands.GeneralisedForces().norm(), 1e-3);
}

TEST(TwoHands, DoNoVirtualWorkTogetherOnAFourBarAtRest) {
  TwoHands hands(PullingApart("four-bar"));
  PullApart(&hands);
  ASSERT_EQ(hands.Run().status, RunStatus::kFinished);
  EXPECT_GT(hands.recording.ticks.back().of_hand(0).sent_F_Ho_D.norm(), 0.5);
  EXPECT_LT(hands.GeneralisedForces().norm(), 1e-3);
}

/// Delays and losses included; without gravity the mechanism has nothing to give but what the hands
/// gave it.
TEST(TwoHands, GetNoMoreEnergyThanTheyGave) {
  for (const char* example : {"four-bar", "stewart-gough"}) {
    for (unsigned seed = 1; seed <= 4; ++seed) {
      SessionSetup setup;
      setup.example = example;
      setup.gravity = false;
      setup.points = {Hand(300, 0.02, 1.3), Hand(500, 0.03, 0.7 * seed)};
      for (PointOptions& point : setup.points) {
        point.seed = seed;
        point.delay_periods = static_cast<int>(seed % 3);
        point.lost_share = 0.05 * (seed % 2);
      }
      TwoHands hands(setup);
      const RunSummary summary = hands.Run();
      const double given = hands.masters[0]->point.given + hands.masters[1]->point.given;
      EXPECT_LE(given, hands.bounds[0] + hands.bounds[1]) << example << seed;
      EXPECT_GE(summary.least_energy, -hands.bounds[0]) << example << seed;
      EXPECT_GE(summary.others.front().least_energy, -hands.bounds[1]) << example << seed;
      EXPECT_EQ(summary.status, RunStatus::kFinished) << example << seed << summary.FullReport();
    }
  }
}

TEST(TwoHands, GoOnAsOneWhereTheOtherIsLostAndFeelNoJump) {
  for (const char* example : {"four-bar", "stewart-gough"}) {
    TwoHands hands(PullingApart(example));
    PullApart(&hands);
    hands.masters[1]->fails_at_ns = 3'000'000'000;
    const RunSummary summary = hands.Run();
    EXPECT_EQ(summary.status, RunStatus::kFinished) << summary.FullReport();
    EXPECT_EQ(summary.others.front().cause, ForceOff::kLinkLost);
    const std::vector<TickRecord>& ticks = hands.recording.ticks;
    const Vector6d before = ticks[2999].of_hand(1).sent_F_Ho_D;
    EXPECT_GT(before.norm(), 0.5);
    EXPECT_EQ(ticks[3001].of_hand(1).sent_F_Ho_D.norm(), 0);
    EXPECT_FALSE(ticks[3001].picture.hand(1).holds);
    double largest = 0;
    for (size_t k = 2900; k + 1 < ticks.size(); ++k) {
      const Vector6d change = ticks[k + 1].sent_F_Ho_D - ticks[k].sent_F_Ho_D;
      largest = std::max(largest, change.head<3>().norm());
    }
    EXPECT_LT(largest, 1) << example;  // [N] a tick
    EXPECT_LT(ticks.back().picture.hand(1).dynamic.norm(), 1e-9) << example;
    EXPECT_LT(hands.GeneralisedForces().norm(), 1e-2) << example;  // one hand alone, at rest
  }
}

/// One hand with the mechanism between it and nobody.
TEST(TwoHands, AreOneHandWhereTheOtherIsAbsent) {
  for (const char* example : {"two-link-arm", "four-bar"}) {
    SessionSetup setup;
    setup.example = example;
    setup.points = {Hand(300, 0.03, 1), Hand(300, 0.03, 1)};
    TwoHands both(setup);
    both.masters[1]->fails_at_ns = 0;
    both.masters[1]->fails_with = IoStatus::kNoNewData;
    both.Run();
    setup.hands = 1;
    TwoHands one(setup);
    one.Run();
    ASSERT_EQ(both.recording.ticks.size(), one.recording.ticks.size());
    double moved = 0, off = 0;
    for (size_t k = 0; k < one.recording.ticks.size(); ++k) {
      const TickRecord &a = one.recording.ticks[k], &b = both.recording.ticks[k];
      moved = std::max(moved, a.sent_F_Ho_D.norm());
      off = std::max({off, (a.sent_F_Ho_D - b.sent_F_Ho_D).norm(), std::abs(a.energy - b.energy),
                      std::abs(a.stored_energy - b.stored_energy),
                      (a.picture.q - b.picture.q).norm(), (a.picture.v - b.picture.v).norm()});
    }
    EXPECT_GT(moved, 1) << example;
    EXPECT_EQ(off, 0) << example;
  }
}

TEST(TwoHands, StopBothWhereOneTrips) {
  TwoHands hands(PullingApart("four-bar"));
  hands.masters[1]->fails_at_ns = 1'000'000'000;
  hands.masters[1]->stopped = true;
  const RunSummary summary = hands.Run();
  EXPECT_EQ(summary.status, RunStatus::kFault);
  EXPECT_EQ(summary.cause, ForceOff::kEmergencyStop);
  EXPECT_EQ(summary.ticks, 1001u);
  for (const auto& master : hands.masters) EXPECT_EQ(master->lifecycle(), Lifecycle::kInactive);
}

TEST(TwoHands, AreRecordedReplayedAndAudited) {
  SessionSetup setup;
  setup.points = {Hand(300, 0.03, 1), Hand(300, 0.02, 1.7)};
  TwoHands hands(setup);
  hands.Run();
  const Recording first = hands.recording;
  const TempFolder folder;
  for (const char* name : {"two.csv", "two.mcap"}) {
    WriteRecording(folder / name, first);
    hands.recording = ReadRecording(folder / name);
    ASSERT_EQ(hands.recording.hands(), 2);
    EXPECT_EQ(hands.recording.others.front().device, "point");
    RecordingAudit audit(hands.recording);
    for (const TickRecord& tick : hands.recording.ticks) audit.Take(tick);
    EXPECT_TRUE(audit.Report().sound()) << audit.Report().Text();
    hands.Replay();
    ASSERT_EQ(hands.recording.ticks.size(), first.ticks.size());
    for (size_t k = 0; k < first.ticks.size(); ++k) {
      for (int i = 0; i < 2; ++i) {
        ASSERT_EQ(hands.recording.ticks[k].of_hand(i).sent_F_Ho_D,
                  first.ticks[k].of_hand(i).sent_F_Ho_D)
            << name << k;
      }
    }
  }
  // A force of the second hand that was changed shows.
  Recording changed = first;
  changed.ticks[1000].picture.hand(1).dynamic[0] += 1;
  RecordingAudit audit(changed);
  for (const TickRecord& tick : changed.ticks) audit.Take(tick);
  EXPECT_FALSE(audit.Report().sound());
}

TEST(TwoHands, AskForADeviceEachAndOneRate) {
  TwoHands hands(PullingApart("four-bar"));
  const VectorXd q = StartCoordinates(hands.tree);
  const std::array coupled{CoupledHand{0, {}}, CoupledHand{1, {}}};
  CoupledTick tick(hands.tree, coupled, q, kPeriod, {});
  FreeRunningClock clock;
  EXPECT_THROW(Runner({}, hands.masters[0].get(), &tick, &clock), std::invalid_argument);
  PointOptions fast;
  fast.period = 5e-4;
  PointMaster other(fast);
  other.Configure();
  const std::array devices{RunnerHand{hands.masters[0].get(), {}, {}}, RunnerHand{&other, {}, {}}};
  EXPECT_THROW(Runner({}, devices, &tick, &clock), std::invalid_argument);
}

}  // namespace
}  // namespace vmech::two_hands_test
