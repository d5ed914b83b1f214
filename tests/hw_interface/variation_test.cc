#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "hw_interface/tick_input.h"
#include "support/examples.h"
#include "vmech/hw_interface/rendering/coupled_tick.h"
#include "vmech/hw_interface/screen/screen_mechanism.h"
#include "vmech/hw_interface/variation/varied_mechanism.h"
#include "vmech/hw_interface/variation/varied_tick.h"
#include "vmech/kinematics/loops/assembled_mechanism.h"
#include "vmech/kinematics/loops/loops.h"
#include "vmech/kinematics/tree/forward_kinematics.h"

namespace vmech::variation_test {
namespace {

constexpr double kPeriod = 1e-3;  // [s]

std::filesystem::path FileOf(const std::string& example) {
  return std::filesystem::path(VMECH_EXAMPLES) / (example + ".yaml");
}

double Distance(const Mechanism& mechanism, const char* link, const char* from, const char* to) {
  const Link& l = mechanism.links[static_cast<size_t>(FindLink(mechanism, link))];
  const auto at = [&](const char* name) {
    return std::find_if(l.anchors.begin(), l.anchors.end(),
                        [&](const Anchor& anchor) { return anchor.name == name; })
        ->X_LA.p;
  };
  return (at(to) - at(from)).norm();
}

/// A mechanism in a hand that pulls to and fro at a firm coupling, while its design is varied.
class SessionOfDesigns {
 public:
  SessionOfDesigns(const std::string& example, const HandCoupling& coupling)
      : source(FileOf(example), {}),
        tree(BuildKinematicTree(AssembleMechanism(source.Read(source.values())).mechanism)),
        guide(&source, tree, {0}) {
    CoupledTickOptions options;
    options.coupling = coupling;
    auto coupled = std::make_unique<CoupledTick>(tree, 0, StartCoordinates(tree), kPeriod, options);
    held = coupled.get();
    tick = std::make_unique<VariedTick>(std::move(coupled), guide.Start());
    tick->Reset();
    X_WG = tick->GraspFrame();
    channels.resize(tick->ChannelNames().size());
    picture.q = StartCoordinates(tree);
    picture.v = VectorXd::Zero(tree.nv);
    picture.joints.resize(tree.mechanism.joints.size());
    picture.design = source.values();
  }

  /// A tick; the other thread's part comes once every eight.
  void Step() {
    if (ticks % 8 == 0) {
      tick->Show(&picture);
      const std::optional<HeldDesign> next =
          guide.Next({picture.q, picture.design, picture.design_arrived, picture.design_stopped});
      if (next) {
        tick->designs().back() = {++number, *next};
        tick->designs().Publish();
      }
    }
    const double time = kPeriod * static_cast<double>(++ticks);
    // A handle in a hand that gives way: what the mechanism puts on it moves it.
    constexpr double kMass = 0.5, kStiffness = 300, kDamping = 25;  // [kg], [N/m], [N s/m]
    const Vector3d wanted = reach * std::sin(2 * M_PI * time) * Vector3d(1, 0.6, 0.3);
    v += kPeriod / kMass * (F.head<3>() + kStiffness * (wanted - way) - kDamping * v);
    way += kPeriod * v;
    const TickInput input = FreshInput({X_WG.R, X_WG.p + way}, kPeriod);
    const TickOutput out = tick->Step(input, channels);
    if (ticks > 1) {
      largest_jump = std::max(largest_jump, (out.F_Ho_W - F).head<3>().norm());
      // What the hand has got, and what it says is left of what it gave.
      balance += -F.head<3>().dot(way - last_way) - (out.stored_energy - stored);
      least = std::min(least, balance);
    }
    F = out.F_Ho_W;
    last_way = way;
    stored = out.stored_energy;
    worst_closure = std::max(worst_closure, held->dynamics().closure());
    fine = fine && out.status == TickStatus::kOk;
  }

  bool Vary(int parameter, double value, int most_ticks) {
    guide.Ask(parameter, value);
    for (int i = 0; i < most_ticks; ++i) {
      Step();
      tick->Show(&picture);
      if (!guide.refusal().empty()) return false;
      if (picture.design == guide.asked() && picture.design_arrived) return true;
    }
    return false;
  }

  VariedMechanism source;
  KinematicTree tree;
  DesignGuide guide;
  std::unique_ptr<VariedTick> tick;
  CoupledTick* held = nullptr;
  TickPicture picture;
  double reach = 0.01;  // of the hand [m]
  long ticks = 0;
  double largest_jump = 0, balance = 0, least = 0, worst_closure = 0;
  bool fine = true;

 private:
  Posed X_WG;
  std::vector<double> channels;
  std::uint64_t number = 0;
  Vector6d F = Vector6d::Zero();
  Vector3d way = Vector3d::Zero(), last_way = Vector3d::Zero(), v = Vector3d::Zero();
  double stored = 0;
};

HandCoupling Firm() {
  HandCoupling coupling;
  coupling.stiffness << 2000, 2000, 2000, 20, 20, 20;
  coupling.damping << 10, 10, 10, 0.1, 0.1, 0.1;
  coupling.max_force = 20;
  coupling.max_moment = 2;
  return coupling;
}

class VariedExample : public testing::TestWithParam<const char*> {};

TEST_P(VariedExample, FollowsEveryParameterFromBoundToBoundWhileAHandMovesIt) {
  const size_t parameters = VariedMechanism(FileOf(GetParam()), {}).parameters().size();
  ASSERT_GT(parameters, 0u);
  for (size_t i = 0; i < parameters; ++i) {
    SessionOfDesigns session(GetParam(), Firm());
    const LiveParameter& moved = session.source.parameters()[i];
    SCOPED_TRACE(moved.name);
    for (int k = 0; k < 1000; ++k) session.Step();
    session.balance = session.least = 0;  // of the fall into the hand's spring, too fast for ticks
    for (const double value : {moved.upper, moved.lower, moved.value}) {
      if (session.Vary(static_cast<int>(i), value, 20000)) continue;
      EXPECT_NE(session.guide.refusal(), "") << "neither there nor refused";
    }
    EXPECT_TRUE(session.fine);
    EXPECT_LT(session.largest_jump, 1);
    EXPECT_LT(session.worst_closure, 1e-9);
    EXPECT_GT(session.least, -1e-3) << "the hand got more than it had given";
  }
}

INSTANTIATE_TEST_SUITE_P(Parameters, VariedExample,
                         testing::Values("four-bar-by-lengths", "hexapod"));

TEST(VariedTick, BecomesTheMechanismOfTheFile) {
  SessionOfDesigns session("four-bar-by-lengths", Firm());
  ASSERT_EQ(session.source.parameters()[1].name, "crank");
  ASSERT_TRUE(session.Vary(1, 0.4, 20000)) << session.guide.refusal();
  ASSERT_TRUE(session.Vary(2, 1.3, 20000)) << session.guide.refusal();
  const HeldDesign now =
      HeldDesignOf(session.source.ReadAt(session.picture.design, session.tree, session.picture.q));
  const Mechanism became = MechanismWith(now, session.tree);
  EXPECT_NEAR(Distance(became, "crank", "main", "crank_pin"), 0.4, 1e-12);
  EXPECT_NEAR(Distance(became, "coupler", "crank_pin", "rocker_pin"), 1.3, 1e-12);
  EXPECT_NEAR(became.links[1].mass_properties.mass, 0.4, 1e-12);
  // The pose that it has come to is closed in a tree that is built of it.
  const KinematicTree tree = BuildKinematicTree(became, {{}, session.tree.spanning.cuts, {}});
  TreeWorkspace<double> ws(tree);
  ForwardKinematics(tree, session.picture.q.data(), &ws);
  LoopErrors(tree, &ws);
  EXPECT_LT(LargestLoopError(tree, ws), 1e-9);
}

/// Of a crank whose mass grows where it stands: dm g h, h over the point that energies count from.
TEST(CoupledDynamics, WorkOfADesignThatGrowsHeavierIsThatOfItsWeight) {
  const Mechanism light = RequireAssembled(Example("crank")).mechanism;
  const KinematicTree tree = BuildKinematicTree(light);
  VectorXd q = StartCoordinates(tree);
  q[0] += 0.7;
  CoupledDynamics dynamics(tree, GraspFrameOf(tree, 0), Firm(), kPeriod, q);
  const HeldDesign before = HeldDesignOf(tree);
  HeldDesign after = before;
  const double added = 1.5;  // [kg]
  after.tree.nodes[0].mass += added;
  ASSERT_EQ(dynamics.ChangeDesign(before, after, {}), DesignStatus::kTaken);
  const Vector3d centre = dynamics.pose().X_WB(0) * after.tree.nodes[0].p_BoBcm;
  const double work = -added * light.gravity_W.dot(centre - tree.reference);
  ASSERT_GT(std::abs(work), 0.1);
  EXPECT_NEAR(dynamics.design_work(), work, 1e-12 * std::abs(work));
}

TEST(VariedTick, IsRefusedWhatCannotBeAssembled) {
  SessionOfDesigns session("four-bar-by-lengths", Firm());
  EXPECT_FALSE(session.Vary(2, 2.4, 100)) << "crank, rocker and ground are 2.35 m together";
  EXPECT_NE(session.guide.refusal().find("coupler = 2.4 m"), std::string::npos);
  EXPECT_EQ(session.picture.design, session.source.values());
  // It goes elsewhere all the same.
  EXPECT_TRUE(session.Vary(2, 1.25, 20000)) << session.guide.refusal();
}

TEST(VariedTick, StopsWhereTheLoopsDoNotCloseAnyFurther) {
  SessionOfDesigns session("four-bar-by-lengths", Firm());
  session.reach = 0;
  Mechanism stretched = session.tree.mechanism;
  Link& coupler = stretched.links[static_cast<size_t>(FindLink(stretched, "coupler"))];
  coupler.anchors[1].X_LA.p.x() = 2.5;  // stretched to a line, the others leave 2.35 m
  const std::vector<int> cuts = session.tree.spanning.cuts, grasps{0, 1};
  VectorXd values = session.source.values();
  values[2] = 2.5;
  HeldDesign out_of_reach =
      HeldDesignOf(BuildKinematicTree(stretched, {{}, cuts, {}}), grasps, values);
  session.tick->designs().back() = {1, out_of_reach};
  session.tick->designs().Publish();
  for (int k = 0; k < 20000 && !session.picture.design_stopped; ++k) {
    session.Step();
    session.tick->Show(&session.picture);
  }
  EXPECT_TRUE(session.picture.design_stopped);
  EXPECT_GT(session.picture.design[2], 1.3);
  EXPECT_LT(session.picture.design[2], 2.35);
  EXPECT_TRUE(session.fine);
  EXPECT_LT(session.largest_jump, 1);
  EXPECT_LT(session.worst_closure, 1e-9);
}

TEST(DesignGuide, RefusesWhatIsNotThere) {
  SessionOfDesigns session("four-bar-by-lengths", Firm());
  EXPECT_THROW(session.guide.Ask(17, 1), std::invalid_argument);
  EXPECT_THROW(session.guide.Ask(-1, 1), std::invalid_argument);
  EXPECT_THROW(session.guide.Ask(1, 1e9), std::invalid_argument);
  EXPECT_THROW(session.guide.Ask(1, std::nan("")), std::invalid_argument);
}

TEST(VariedMechanism, WritesItsValuesIntoTheFile) {
  VariedMechanism source(FileOf("four-bar-by-lengths"), {});
  VectorXd values = source.values();
  values[1] = 0.4321;
  const std::string text = source.TextWith(values);
  MechanismSource again(text, "again.yaml");
  const Mechanism mechanism = again.Read();
  EXPECT_NEAR(Distance(mechanism, "crank", "main", "crank_pin"), 0.4321, 1e-15);
  EXPECT_NE(text.find("# The four-bar linkage"), std::string::npos) << "comments stay";
  EXPECT_NE(text.find("ground - crank*cos(turn)"), std::string::npos) << "formulas stay";
}

class VariedOnScreen : public testing::TestWithParam<const char*> {};

TEST_P(VariedOnScreen, FollowsEveryParameterInTheMousesHand) {
  VariedMechanism source(FileOf(GetParam()), {});
  for (size_t i = 0; i < source.parameters().size(); ++i) {
    const LiveParameter& moved = source.parameters()[i];
    SCOPED_TRACE(moved.name);
    ScreenMechanism screen(AssembleMechanism(source.Read(source.values())).mechanism);
    DesignGuide guide(&source, screen.tree(), {});
    const HeldDesign start = guide.Start();
    screen.Grab(1, Vector3d::Zero());
    const double wanted = 0.9 * moved.value + 0.1 * moved.upper;
    guide.Ask(static_cast<int>(i), wanted);
    VectorXd values = source.values();
    for (int k = 0; k < 2000 && guide.refusal().empty() && values != guide.asked(); ++k) {
      const DesignPath* path = screen.design();
      const VectorXd q = screen.q();
      const auto next = guide.Next(
          {q, values, path == nullptr || path->arrived(), path != nullptr && path->stopped()});
      if (next) screen.VaryTo(start, *next);
      screen.Advance(4);
      if (screen.design() != nullptr) values = screen.design()->now().values;
    }
    EXPECT_EQ(guide.refusal(), "");
    EXPECT_EQ(values[static_cast<Eigen::Index>(i)], wanted);
    EXPECT_LT(screen.State().closure, 1e-9);
  }
}

INSTANTIATE_TEST_SUITE_P(Parameters, VariedOnScreen,
                         testing::Values("four-bar-by-lengths", "hexapod-leg", "hexapod"));

TEST(ScreenMechanism, StandsStillWhileItsDesignIsVaried) {
  VariedMechanism source(FileOf("four-bar-by-lengths"), {});
  ScreenMechanism screen(AssembleMechanism(source.Read(source.values())).mechanism);
  DesignGuide guide(&source, screen.tree(), {});
  const HeldDesign start = guide.Start();
  guide.Ask(1, 0.4);
  const VectorXd begin = screen.q();
  for (int i = 0; i < 2000; ++i) {
    const DesignPath* path = screen.design();
    const VectorXd values = path != nullptr ? path->now().values : source.values();
    const bool arrived = path == nullptr || path->arrived();
    const VectorXd q = screen.q();
    if (const auto next = guide.Next({q, values, arrived, path != nullptr && path->stopped()})) {
      screen.VaryTo(start, *next);
    }
    screen.Advance(4);
  }
  ASSERT_TRUE(guide.refusal().empty()) << guide.refusal();
  EXPECT_NEAR(Distance(screen.mechanism(), "crank", "main", "crank_pin"), 0.4, 1e-12);
  EXPECT_LT(screen.State().closure, 1e-9);
  EXPECT_EQ(screen.State().mode, ScreenMode::kFrozen);
  EXPECT_LT((screen.q() - begin).norm(), 0.5) << "on the same branch";
}

}  // namespace
}  // namespace vmech::variation_test
