#include "vmech/kinematics/loops/assembled_mechanism.h"

#include <gtest/gtest.h>

#include <stdexcept>

#include "support/rounded.h"
#include "vmech/kinematics/loops/closure.h"
#include "vmech/kinematics/loops/loops.h"
#include "vmech/kinematics/loops/mobility.h"

namespace vmech {
namespace {

constexpr double kClosed = 1e-13;

int MobilityOf(const AssembledMechanism& assembled) {
  const KinematicTree tree = BuildKinematicTree(assembled.mechanism);
  return AnalyseMobility(tree, StartCoordinates(tree)).mobility;
}

double ErrorAtStart(const Mechanism& mechanism, const SpanningTreeOptions& cuts = {}) {
  const KinematicTree tree = BuildKinematicTree(mechanism, cuts);
  TreeWorkspace<double> ws(tree);
  EvaluatePose(tree, StartCoordinates(tree), &ws);
  return LargestLoopError(tree, ws);
}

bool Mentions(const std::vector<std::string>& notes, const std::string& words) {
  for (const std::string& note : notes) {
    if (note.find(words) != std::string::npos) return true;
  }
  return false;
}

// Axes typed with six and with seven digits: 0.5 * 4e-7 rad off parallel, a cross product.
const std::string kInclined = R"(vmech: "1.0"
gravity: [0, 0, -9.81]
ground: frame
links:
  frame:
    anchors:
      a: {origin: [0, 0, 0], z: [0, -0.5, 0.8660254], x: [1, 0, 0]}
      d: {origin: [1, 0, 0], z: [0, -0.5, 0.866025], x: [1, 0, 0]}
  crank:   {mass: 1, center_of_gravity: [0.1, 0, 0],
      anchors: {a: {origin: [0, 0, 0]}, b: {origin: [0.2, 0, 0]}}}
  coupler: {mass: 1, center_of_gravity: [0.5, 0, 0],
      anchors: {b: {origin: [0, 0, 0]}, c: {origin: [1, 0, 0]}}}
  rocker:  {mass: 1, center_of_gravity: [0.3, 0, 0],
      anchors: {c: {origin: [0.6, 0, 0]}, d: {origin: [0, 0, 0]}}}
joints:
  a: {type: revolute, connects: [frame/a, crank/a], start: 1}
  b: {type: revolute, connects: [crank/b, coupler/b], start: -0.6}
  c: {type: revolute, connects: [coupler/c, rocker/c], start: 0.7}
  d: {type: revolute, connects: [frame/d, rocker/d], start: 1.2}
)";

TEST(AssembledMechanism, ClosesAxesThatAreTypedWithSixAndSevenDigits) {
  const AssembledMechanism assembled = AssembleMechanism(ParseMechanism(kInclined, "inclined"));
  ASSERT_TRUE(assembled.summary.closed) << assembled.summary.message;
  EXPECT_EQ(MobilityOf(assembled), 1);
  ASSERT_EQ(assembled.misfits.size(), 1);
  EXPECT_NEAR(assembled.misfits[0].angle, 2.0e-7, 1e-12);
  EXPECT_TRUE(assembled.misfits[0].parallel);
  EXPECT_TRUE(Mentions(assembled.Notes(),
                       "the axes of 'a' and 'd' on 'frame' are 0.2 urad off "
                       "parallel"));
}

TEST(AssembledMechanism, RefusesRoundingBeyondTheTolerance) {
  Mechanism mechanism = ParseMechanism(kInclined, "inclined");
  mechanism.tolerance = 1e-8;
  const AssembledMechanism assembled = AssembleMechanism(mechanism);
  EXPECT_FALSE(assembled.summary.closed);
  EXPECT_NE(assembled.summary.message.find("'a' and 'd' on 'frame'"), std::string::npos);
  EXPECT_NE(assembled.summary.message.find("--tolerance"), std::string::npos);
  EXPECT_THROW(RequireAssembled(mechanism), std::runtime_error);
}

TEST(AssembledMechanism, MovesWithTheDigits) {
  double last = 1;
  for (const int digits : {4, 5, 6, 9, 12}) {
    const AssembledMechanism assembled =
        AssembleMechanism(DrawnWithDigits(Example("bennett"), digits, 3));
    ASSERT_TRUE(assembled.summary.closed) << digits;
    EXPECT_LT(assembled.correction, 0.5 * last);
    EXPECT_GT(assembled.correction, 1e-4 * std::pow(10, -digits));
    last = assembled.correction;
  }
}

TEST(AssembledMechanism, LeavesExactFiguresAsTheyAre) {
  for (const std::string& name : ExampleNames()) {
    const Mechanism drawn = Example(name);
    const AssembledMechanism assembled = AssembleMechanism(drawn);
    ASSERT_TRUE(assembled.summary.closed) << name;
    EXPECT_EQ(assembled.correction, 0) << name;
    for (size_t i = 0; i < drawn.links.size(); ++i) {
      for (size_t a = 0; a < drawn.links[i].anchors.size(); ++a) {
        EXPECT_EQ(assembled.mechanism.links[i].anchors[a].X_LA.R, drawn.links[i].anchors[a].X_LA.R);
      }
    }
  }
}

TEST(AssembledMechanism, ClosesWhereverTheLoopsAreCutAfterwards) {
  for (const char* name : {"four-bar", "slider-crank", "stewart-gough", "andrews-squeezer"}) {
    const Mechanism mechanism = AssembleMechanism(Example(name)).mechanism;
    for (size_t j = 0; j < mechanism.joints.size(); ++j) {
      SpanningTreeOptions cuts;
      cuts.cut = {static_cast<int>(j)};
      EXPECT_LE(ErrorAtStart(mechanism, cuts), kClosed) << name << " cut at " << j;
    }
  }
}

// A four-bar whose links lie in line where all coordinates are zero.
const std::string kFlat = R"(vmech: "1.0"
units: {length: m, angle: deg}
gravity: [0, -9.81, 0]
ground: frame
links:
  frame:   {anchors: {A: {origin: [0, 0, 0]}, D: {origin: [1, 0, 0]}}}
  crank:   {mass: 1, center_of_gravity: [0.25, 0, 0],
      anchors: {A: {origin: [0, 0, 0]}, B: {origin: [0.5, 0, 0]}}}
  coupler: {mass: 1, center_of_gravity: [0.6, 0, 0],
      anchors: {B: {origin: [0, 0, 0]}, C: {origin: [1.2, 0, 0]}}}
  rocker:  {mass: 1, center_of_gravity: [0.4, 0, 0],
      anchors: {C: {origin: [0.8, 0, 0]}, D: {origin: [0, 0, 0]}}}
joints:
  A: {type: revolute, connects: [frame/A, crank/A]}
  B: {type: revolute, connects: [crank/B, coupler/B]}
  C: {type: revolute, connects: [coupler/C, rocker/C]}
  D: {type: revolute, connects: [frame/D, rocker/D]}
)";

TEST(AssembledMechanism, LeavesAFlatStart) {
  const AssembledMechanism assembled = AssembleMechanism(ParseMechanism(kFlat, "flat"));
  ASSERT_TRUE(assembled.summary.closed) << assembled.summary.message;
  EXPECT_EQ(MobilityOf(assembled), 1);
  EXPECT_TRUE(Mentions(assembled.Notes(), "the start values lead to no assembled pose"));
}

TEST(AssembledMechanism, SaysWhereNoStartLeads) {
  std::string impossible = kFlat;
  impossible.replace(impossible.find("C: {origin: [1.2"), 16, "C: {origin: [9.2");
  const AssembledMechanism assembled = AssembleMechanism(ParseMechanism(impossible, "long"));
  EXPECT_FALSE(assembled.summary.closed);
  EXPECT_GT(assembled.summary.starts, 1);
  EXPECT_NE(assembled.summary.message.find("cannot be closed"), std::string::npos);
  EXPECT_NE(assembled.summary.message.find(" deg apart"), std::string::npos);
}

TEST(AssembledMechanism, SaysWhichStatedStartItMovedInTheUnitsOfTheFile) {
  std::string stated = kFlat;
  stated.replace(stated.find("crank/A]"), 8, "crank/A], start: 60");
  stated.replace(stated.find("rocker/D]"), 9, "rocker/D], start: 80");
  const AssembledMechanism assembled = AssembleMechanism(ParseMechanism(stated, "stated"));
  ASSERT_TRUE(assembled.summary.closed);
  ASSERT_FALSE(assembled.moved_starts.empty());
  EXPECT_TRUE(Mentions(assembled.Notes(), "from 80 deg to")) << assembled.Notes()[0];
}

TEST(AssembledMechanism, KeepsTheJointsThatAreFixed) {
  Mechanism mechanism = ParseMechanism(kFlat, "fixed");
  mechanism.joints[0].start = {0.7};
  AssembleOptions options;
  options.fixed_joints = {0};
  const AssembledMechanism assembled = AssembleMechanism(mechanism, options);
  ASSERT_TRUE(assembled.summary.closed);
  EXPECT_EQ(assembled.mechanism.joints[0].start[0], 0.7);
}

TEST(AssembledMechanism, SaysWhoStartsOutsideItsLimits) {
  Mechanism mechanism = ParseMechanism(kFlat, "limits");
  mechanism.joints[0].lower = {2.5};
  mechanism.joints[0].upper = {2.6};
  const std::vector<std::string> outside =
      StartsOutsideLimits(AssembleMechanism(mechanism).mechanism);
  ASSERT_EQ(outside.size(), 1);
  EXPECT_NE(outside[0].find("joint 'A' starts at"), std::string::npos);
}

// A loop between parts that are welded to each other has rows and no columns.
TEST(AssembledMechanism, ClosesALoopThatNothingCanMove) {
  const AssembledMechanism assembled = AssembleMechanism(ParseMechanism(R"(vmech: "1.0"
gravity: [0, 0, -9.81]
ground: frame
links:
  frame: {anchors: {a: {origin: [0, 0, 0]}, b: {origin: [1, 0, 0]}}}
  plate: {mass: 1, anchors: {a: {origin: [0, 0, 0]}, b: {origin: [1, 0, 0]}}}
joints:
  weld: {type: weld, connects: [frame/a, plate/a]}
  ball: {type: spherical, connects: [frame/b, plate/b]}
)",
                                                                        "welded"));
  EXPECT_TRUE(assembled.summary.closed) << assembled.summary.message;
  EXPECT_EQ(MobilityOf(assembled), 0);
}

// Rounding tells from a small eccentric: what moves as drawn is taken as drawn.
TEST(AssembledMechanism, TakesNoSmallEccentricForRounding) {
  std::string eccentric = kFlat;
  eccentric.replace(eccentric.find("B: {origin: [0.5"), 16, "B: {origin: [5e-5");
  eccentric.replace(eccentric.find("C: {origin: [1.2"), 16, "C: {origin: [0.9");
  const AssembledMechanism assembled = AssembleMechanism(ParseMechanism(eccentric, "eccentric"));
  ASSERT_TRUE(assembled.summary.closed) << assembled.summary.message;
  EXPECT_EQ(assembled.correction, 0);
  EXPECT_EQ(MobilityOf(assembled), 1);
}

}  // namespace
}  // namespace vmech
