/// What a recording says of its session: numbers that hold, and figures of what was felt. Sessions
/// of a simulated arm whose truth is known.

#include "vmech/hw_interface/audit/audit.h"

#include <gtest/gtest.h>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <string>

#include "hw_interface/tick_input.h"
#include "support/examples.h"
#include "vmech/dynamics/in_hand/passive_joints.h"
#include "vmech/hw_interface/audit/felt.h"
#include "vmech/hw_interface/audit/promise.h"
#include "vmech/hw_interface/audit/recorded_tree.h"
#include "vmech/hw_interface/loop/replay_master.h"
#include "vmech/hw_interface/loop/runner.h"
#include "vmech/hw_interface/masters/simulated_master.h"
#include "vmech/hw_interface/recording/columns.h"
#include "vmech/hw_interface/rendering/coupled_tick.h"
#include "vmech/hw_interface/rendering/coupling_choice.h"
#include "vmech/hw_interface/rendering/mechanism_tick.h"
#include "vmech/hw_interface/rendering/paper_choice.h"
#include "vmech/kinematics/loops/assembled_mechanism.h"

namespace vmech::audit_test {
namespace {

struct SessionOptions {
  std::string example = "slider-crank";
  bool paper = false;
  double scale = 1;
  int delay_periods = 0;
  double seconds = 3;
};

SimulatedMasterOptions ArmFor(const SessionOptions& options) {
  SimulatedMasterOptions arm;
  arm.hand = ImpedanceOf(Grip::kFirm);
  arm.delay_periods = options.delay_periods;
  const auto description = std::make_shared<const ArmDescription>(SarcosMasterArm());
  arm.motion = Wander(ArmModel(description).X_DH(), 0.03, 0.1, 3);
  return arm;
}

/// A mechanism in the hand of a simulated operator who wanders, and all that is recorded of it.
class Session {
 public:
  explicit Session(const SessionOptions& options)
      : mechanism_(Example(options.example)),
        tree_(BuildKinematicTree(mechanism_, KeepPassiveJoints(mechanism_))),
        grasp_(FindGrasp(mechanism_, "handle")),
        master_(ArmFor(options)) {
    SetStart();
    master_.Configure();
    if (options.paper) {
      MakePaper();
    } else {
      MakeCoupled(options.scale);
    }
    recording = Run(&master_, options.seconds);
  }

  /// The same session again, from what was recorded of the hand.
  Recording Again() {
    ReplayMaster replay(recording, ReplayKind::kSession);
    replay.Configure();
    return Run(&replay, recording.period * static_cast<double>(recording.ticks.size()));
  }

  Recording recording;
  SessionPromise promise;

 private:
  /// The tree starts where the loops are closed, as the recorded mechanism says.
  void SetStart() {
    q_ = ClosedStart(tree_);
    SetStarts(tree_, q_, &mechanism_);
    tree_ = BuildKinematicTree(mechanism_, KeepPassiveJoints(mechanism_));
    q_ = StartCoordinates(tree_);
  }
  void MakeCoupled(double scale) {
    CoupledTickOptions options;
    const CouplingChoice choice =
        ChooseCoupling(tree_, GraspFrameOf(tree_, grasp_), q_, master_.info(), options.smoothing);
    options.coupling = choice.coupling;
    options.scale = scale * choice.scale;
    safety_ = choice.Safety();
    promise = {true, false, options.scale, 1, options.coupling};
    promise.coupling.stiffness /= options.scale;
    promise.coupling.damping /= options.scale;
    promise.coupling.max_force /= options.scale;
    promise.coupling.max_moment /= options.scale;
    tick_ = [this, options]() -> std::unique_ptr<Tick> {
      return std::make_unique<CoupledTick>(tree_, grasp_, q_, 1e-3, options);
    };
  }
  void MakePaper() {
    const PaperChoice choice = ChoosePaper({}, tree_, grasp_, q_, master_.info());
    const MechanismTickOptions& options = choice.tick;
    safety_ = choice.safety;
    observer_ = choice.observer;
    promise = {true, true, options.scale, options.inertia, {}};
    promise.coupling.stiffness = options.law.stiffness / options.scale;
    promise.roll_off = options.LagOfInertia();
    tick_ = [this, options]() -> std::unique_ptr<Tick> {
      return std::make_unique<MechanismTick>(tree_, grasp_, q_, master_.info(), options);
    };
  }
  Recording Run(Master* master, double seconds) {
    RunnerOptions options;
    options.seconds = seconds;
    options.record = true;
    options.realtime.reset();
    options.safety = safety_;
    options.observer = observer_;
    options.mechanism = RecordedMechanismOf(tree_);
    options.notes = {{"grasp", "handle"}, {"coupling", promise.paper ? "paper" : "virtual"}};
    for (const auto& note : NotesOf(promise)) options.notes.push_back(note);
    const std::unique_ptr<Tick> tick = tick_();
    FreeRunningClock clock;
    Runner runner(options, master, tick.get(), &clock);
    EXPECT_EQ(runner.Run().status, RunStatus::kFinished);
    return runner.Kept();
  }

  Mechanism mechanism_;
  KinematicTree tree_;
  int grasp_;
  VectorXd q_;
  SimulatedMaster master_;
  SafetyOptions safety_;
  HandObserverOptions observer_;
  std::function<std::unique_ptr<Tick>()> tick_;
};

/// Of the ticks from `begin` on, at most `count`.
AuditReport Audited(const Recording& recording, size_t begin = 0, size_t count = 1'000'000) {
  RecordingAudit audit(recording);
  const size_t end = std::min(recording.ticks.size(), begin + count);
  for (size_t k = begin; k < end; ++k) audit.Take(recording.ticks[k]);
  return audit.Report();
}

FeltReport FeltIn(const Recording& recording) {
  const RecordedTree held(recording);
  FeltFit fit(recording, held);
  for (const TickRecord& tick : recording.ticks) fit.Take(tick);
  return fit.Report();
}

const Session& OfTheSliderCrank() {
  static const Session session(SessionOptions{});
  return session;
}

class EverySession : public testing::TestWithParam<std::pair<const char*, bool>> {};

TEST_P(EverySession, IsSound) {
  SessionOptions options;
  options.example = GetParam().first;
  options.paper = GetParam().second;
  options.seconds = 1.5;
  const Session session(options);
  const AuditReport report = Audited(session.recording);
  EXPECT_TRUE(report.sound()) << report.Text();
  EXPECT_EQ(report.ticks, 1500u);
  EXPECT_GT(report.energy.throughput, 0.01);
  if (!options.paper) return;
  // What the hand felt of the constraints is what was promised, however light the mechanism.
  const Felt stiffness = FeltIn(session.recording).stiffness;
  EXPECT_NEAR(stiffness.promised, session.promise.scale * session.promise.coupling.stiffness[0],
              1e-9);
  if (stiffness.known) EXPECT_NEAR(stiffness.value / stiffness.promised, 1, 0.05);
}

INSTANTIATE_TEST_SUITE_P(Examples, EverySession,
                         testing::Values(std::pair{"crank", false}, std::pair{"slider-crank", true},
                                         std::pair{"two-link-arm", true},
                                         std::pair{"four-bar", true}, std::pair{"four-bar", false},
                                         std::pair{"rssr", false}, std::pair{"rssr", true},
                                         std::pair{"stewart-gough", false},
                                         std::pair{"stewart-gough-sps", true}));

/// One number in the middle of a session, a little off: the audit finds it, whichever it is.
void FindEveryNumberThatWasTamperedWith(const Recording& whole, size_t begin_tick, size_t count) {
  const size_t tampered_tick = begin_tick + count - 10;
  ASSERT_TRUE(Audited(whole, begin_tick, count).sound())
      << Audited(whole, begin_tick, count).Text();
  const std::vector<Column> columns = ColumnsOf(whole);
  std::string row;
  AppendRow(whole, whole.ticks[tampered_tick], &row);
  int tampered = 0;
  size_t begin = 0;
  for (const Column& column : columns) {
    const size_t end = std::min(row.find(',', begin), row.size());
    const std::string& name = column.name;
    const bool of_the_mechanism = name.starts_with("coordinate") || name.starts_with("velocity") ||
                                  name.starts_with("joint") || name.starts_with("X_W") ||
                                  name.starts_with("hand_p") || name.starts_with("R_HK") ||
                                  name.starts_with("dynamic") || name.starts_with("wanted") ||
                                  name.starts_with("sent") || name == "stored_energy";
    // (w, 0, 0, 0) is the same turn for every w; a channel of the tick only says that w_d was
    // bounded.
    if (of_the_mechanism && !name.ends_with("_w") && name != "dynamic_force") {
      const double value = std::stod(row.substr(begin, end - begin));
      const double size = name.starts_with("joint") || name.starts_with("dynamic") ? 10 : 0.01;
      std::string other = row;
      other.replace(begin, end - begin, fmt::to_string(value + size));
      Recording changed{static_cast<const RecordingHeader&>(whole), {}};
      const auto first = whole.ticks.begin() + static_cast<std::ptrdiff_t>(begin_tick);
      changed.ticks.assign(first, first + static_cast<std::ptrdiff_t>(count));
      ReadRow(whole, columns, other, &changed.ticks[tampered_tick - begin_tick]);
      EXPECT_FALSE(Audited(changed).sound()) << name;
      ++tampered;
    }
    begin = end + 1;
  }
  EXPECT_GT(tampered, 60);
}

TEST(Audit, FindsEveryNumberThatWasTamperedWith) {
  FindEveryNumberThatWasTamperedWith(OfTheSliderCrank().recording, 1500, 20);
}

TEST(Audit, FindsEveryNumberThatWasTamperedWithInThePapersWay) {
  // From the first tick on: the inertia's motion has a memory.
  FindEveryNumberThatWasTamperedWith(Session({"slider-crank", true}).recording, 0, 530);
}

TEST(Audit, EnergyGoesWhereItIsSaidToGo) {
  for (const bool paper : {false, true}) {
    const AuditReport report = paper ? Audited(Session({"slider-crank", true}).recording)
                                     : Audited(OfTheSliderCrank().recording);
    const EnergyBalance& e = report.energy;
    EXPECT_EQ(e.follows, paper);
    EXPECT_NEAR(e.hand, e.kinetic + e.weight + e.joints + e.taken + e.withheld + e.untraced, 1e-12);
    EXPECT_GT(e.taken, 0);  // implicit steps and a lag only take
    EXPECT_LE(e.untraced_most, e.untraced_bound);
    EXPECT_LT(e.untraced_most, (paper ? 1e-3 : 0.02) * e.throughput) << e.Text();
    EXPECT_LT(e.constraint, 1e-6 * e.throughput);
  }
}

TEST(Audit, SaysWhatIsMissing) {
  Recording bare{static_cast<const RecordingHeader&>(OfTheSliderCrank().recording), {}};
  bare.mechanism.text.clear();
  EXPECT_THROW(RecordingAudit{bare}, std::invalid_argument);
}

/// With the hand's observer at work, whose outcome is recorded.
TEST(Replay, IsTheSessionToTheLastBit) {
  Session session({"four-bar", false, 1, 0, 1});
  const Recording again = session.Again();
  ASSERT_EQ(again.ticks.size(), session.recording.ticks.size());
  for (size_t k = 0; k < again.ticks.size(); ++k) {
    TickRecord a = again.ticks[k], b = session.recording.ticks[k];
    ASSERT_TRUE(b.observed);
    a.compute_ns = b.compute_ns = 0;
    std::string row, other;
    AppendRow(again, a, &row);
    AppendRow(session.recording, b, &other);
    ASSERT_EQ(row, other) << k;
  }
}

TEST(Felt, IsTheMechanismsOwnInertiaAndTheCouplingsStiffness) {
  for (const double scale : {1.0, 0.5}) {
    SessionOptions options;
    options.scale = scale;
    options.seconds = 6;
    const Session session(options);
    const FeltReport felt = FeltIn(session.recording);
    const double k = session.promise.scale * session.promise.coupling.stiffness[0];
    EXPECT_NEAR(felt.inertia.value, 1, 0.06) << felt.Text();
    EXPECT_NEAR(felt.weight.value, 1, 0.03) << felt.Text();
    EXPECT_NEAR(felt.stiffness.value / k, 1, 0.03) << felt.Text();
    EXPECT_EQ(felt.stiffness.promised, k);
    EXPECT_NE(felt.Verdict().find("inertia was felt as promised"), std::string::npos)
        << felt.Text() << felt.Verdict();
  }
}

/// A device that exerts a fifth more than it is told.
TEST(Felt, TellsWhatADeviceMakesOfIt) {
  Recording recording = OfTheSliderCrank().recording;
  const FeltReport honest = FeltIn(recording);
  for (TickRecord& tick : recording.ticks) tick.state.applied_F_Ho_D *= 1.2;
  const FeltReport felt = FeltIn(recording);
  EXPECT_NEAR(felt.stiffness.value, 1.2 * honest.stiffness.value, 1e-6 * honest.stiffness.value);
  EXPECT_NEAR(felt.weight.value, 1.2 * honest.weight.value, 1e-6);
  EXPECT_NE(felt.Verdict().find("% more than promised"), std::string::npos) << felt.Verdict();
}

TEST(Felt, MeasuresTheDelayOfTheDevice) {
  for (const int periods : {0, 2, 4}) {
    SessionOptions options;
    options.example = "crank";
    options.delay_periods = periods;
    const FeltReport felt = FeltIn(Session(options).recording);
    EXPECT_NEAR(felt.delay.value, 1e-3 * periods, 3e-4) << felt.Text();
    EXPECT_EQ(felt.delay.promised, 1e-3 * periods);
  }
}

TEST(Felt, SaysNothingOfAHandThatRests) {
  Recording recording = OfTheSliderCrank().recording;
  recording.ticks.resize(100);
  const FeltReport felt = FeltIn(recording);
  EXPECT_NE(felt.Verdict().find("too little"), std::string::npos);
}

/// The legs spin between their ball joints, and the hand does not feel that.
TEST(Felt, SaysThatAFreedomIsOutOfReach) {
  SessionOptions options;
  options.example = "stewart-gough-sps";
  const FeltReport felt = FeltIn(Session(options).recording);
  EXPECT_TRUE(felt.unreached);
  EXPECT_FALSE(felt.inertia.known);
  EXPECT_NE(felt.Text().find("freedoms that the hand does not reach"), std::string::npos);
  EXPECT_NE(felt.Verdict().find("does not reach every freedom"), std::string::npos);
  EXPECT_FALSE(FeltIn(OfTheSliderCrank().recording).unreached);
}

TEST(Felt, CountsWhatWasWithheldAndWhy) {
  Recording recording = OfTheSliderCrank().recording;
  for (int k = 1000; k < 1300; ++k) recording.ticks[k].off = ForceOff::kDeadMan;
  const FeltReport felt = FeltIn(recording);
  EXPECT_EQ(felt.off[static_cast<size_t>(ForceOff::kDeadMan)], 300u);
  EXPECT_NE(felt.Text().find("no force: dead man"), std::string::npos);
  EXPECT_NE(felt.Verdict().find("no force in 10 %"), std::string::npos) << felt.Verdict();
}

}  // namespace
}  // namespace vmech::audit_test
