#include "vmech/kinematics/inverse/assembly_modes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "support/examples.h"

namespace vmech {
namespace {

constexpr double kPublished = 1e-5;  // six decimals, of modes that are nearly singular

// Where the platform is in the 40 modes [m], computed anew from the parameters; they agree with the
// list that PHCpack ships within 2e-6.
constexpr double kDietmaier[40][3] = {
    {0.442199, -0.713494, -0.543494}, {0.443038, -0.558622, -0.701185},
    {0.458734, -0.373481, -0.806272}, {0.477891, -0.781099, -0.401876},
    {0.484612, -0.873935, -0.037278}, {0.485481, -0.200818, -0.850870},
    {0.489122, 0.696230, -0.525379},  {0.521848, 0.810720, 0.265345},
    {0.534003, 0.006174, -0.845460},  {0.535060, -0.749596, -0.389637},
    {0.539848, 0.678840, 0.497734},   {0.585911, 0.161498, -0.794120},
    {0.636112, 0.771452, 0.014956},   {0.667532, 0.738317, -0.096379},
    {0.679796, 0.348061, -0.645547},  {0.689418, 0.593656, -0.415060},
    {0.707963, 0.685868, -0.168443},  {0.719131, 0.633883, -0.284681},
    {0.781100, 0.068798, -0.620604},  {0.803268, -0.296007, 0.516856},
    {0.825080, -0.318926, 0.466400},  {0.832285, -0.282752, 0.476816},
    {0.854376, -0.294203, 0.428352},  {0.855766, -0.334679, 0.394532},
    {0.863326, 0.005644, -0.504616},  {0.870078, -0.451122, -0.198631},
    {0.891375, -0.079827, -0.446182}, {0.903174, -0.418445, 0.095812},
    {0.917778, -0.111176, 0.381213},  {0.955868, -0.046996, -0.290013},
    {0.958098, -0.284039, -0.037012}, {0.968094, 0.236773, -0.082048},
    {0.989132, 0.116671, 0.089471},   {0.991613, -0.127016, 0.023867},
    {0.993577, 0.079665, -0.080359},  {0.993726, 0.111786, 0.003613},
    {0.995368, -0.051199, 0.081376},  {0.998523, 0.031196, 0.044477},
    {0.998901, -0.041564, -0.021652}, {0.999628, 0.026176, -0.007724}};

// The 16 solutions for the hand pose of Manseur & Doty [rad], each with residuals below 1e-15.
constexpr double kManseurDoty[16][6] = {
    {-3.108888, 1.888301, -2.578442, -0.099366, -2.874113, 3.134271},
    {-3.108888, 1.888301, 0.563151, -3.042227, -0.267479, -0.007322},
    {-2.108155, 3.007802, -3.125411, 0.546846, -2.560663, 2.492695},
    {-2.108155, 3.007802, 0.016182, 2.594746, -0.580930, -0.648898},
    {-1.680482, -0.109495, 3.141049, 0.671707, 0.917168, -0.687742},
    {-1.680482, -0.109495, -0.000543, 2.469886, 2.224425, 2.453851},
    {-0.225897, -1.834277, 1.134894, 3.088823, 3.012142, 1.755420},
    {-0.225897, -1.834277, -2.006699, 0.052769, 0.129451, -1.386172},
    {0.043934, 1.886280, 1.955522, -0.183661, 0.000089, -0.001912},
    {0.043934, 1.886280, -1.186071, -2.957932, 3.141503, 3.139681},
    {1.547731, -3.084428, -3.084504, -1.103779, 2.743586, 2.451082},
    {1.547731, -3.084428, 0.057089, -2.037814, 0.398006, -0.690511},
    {1.986946, 0.092614, -3.102223, -0.976061, -1.099293, -0.757077},
    {1.986946, 0.092614, 0.039370, -2.165532, -2.042300, 2.384515},
    {2.937772, -1.813260, -0.582874, -2.840682, -0.141734, -1.428288},
    {2.937772, -1.813260, 2.558719, -0.300911, -2.999859, 1.713305}};

AssemblyModesOptions HoldingLegs(const KinematicTree& tree) {
  AssemblyModesOptions options;
  for (int leg = 1; leg <= 6; ++leg) {
    const int joint = FindJoint(tree.mechanism, "leg" + std::to_string(leg));
    options.fixed.push_back(VelocityIndex(tree, joint, 0));
  }
  // A leg may be turned by half a turn about its axis: of the 64 ways to do so one is enough.
  options.links = {FindLink(tree.mechanism, "platform")};
  return options;
}

AssemblyModesOptions HoldingJoint(const KinematicTree& tree, const std::string& name) {
  AssemblyModesOptions options;
  options.fixed = {VelocityIndex(tree, FindJoint(tree.mechanism, name), 0)};
  options.patience = 200;
  return options;
}

KinematicTree TreeOf(const std::string& example, const std::vector<std::string>& keep = {}) {
  const Mechanism mechanism = Example(example);
  SpanningTreeOptions cuts;
  for (const std::string& joint : keep) cuts.keep.push_back(FindJoint(mechanism, joint));
  return BuildKinematicTree(mechanism, cuts);
}

TEST(AssemblyModes, AreTheFortyOfDietmaiersPlatform) {
  const KinematicTree tree = TreeOf("dietmaier-platform");
  const AssemblyModes found = FindAssemblyModes(tree, HoldingLegs(tree), StartCoordinates(tree));
  ASSERT_EQ(found.modes.size(), 40U) << found.BriefReport();
  EXPECT_TRUE(found.settled);
  GraspFrame platform = GraspFrameOf(tree, 0);
  platform.X_BG = tree.X_node_link(FindLink(tree.mechanism, "platform"));
  InverseKinematics pose(tree, platform);
  for (const auto& p : kDietmaier) {
    const Vector3d published(p[0], p[1], p[2]);
    double nearest = 1;
    for (const AssemblyMode& mode : found.modes) {
      nearest = std::min(nearest, (pose.GraspPose(mode.q).p - published).norm());
      EXPECT_LE(mode.error, 1e-13);
      EXPECT_TRUE(mode.isolated);
    }
    EXPECT_LT(nearest, kPublished) << published.transpose();
  }
}

TEST(AssemblyModes, AreTheSixteenOfTheArmOfManseurAndDoty) {
  const KinematicTree tree = TreeOf("manseur-doty");
  const VectorXd q = StartCoordinates(tree);
  const GraspFrame grasp = GraspFrameOf(tree, 0);
  AssemblyModesOptions options;
  options.hand = HandPose{grasp, InverseKinematics(tree, grasp).GraspPose(q)};
  const AssemblyModes found = FindAssemblyModes(tree, options, q);
  ASSERT_EQ(found.modes.size(), 16U) << found.BriefReport();
  for (const auto& published : kManseurDoty) {
    double nearest = 1;
    for (const AssemblyMode& mode : found.modes) {
      double distance = 0;
      for (int i = 0; i < 6; ++i) {
        const double turn = std::remainder(mode.q[i] - published[i], 2 * std::numbers::pi);
        distance = std::max(distance, std::abs(turn));
      }
      nearest = std::min(nearest, distance);
    }
    EXPECT_LT(nearest, kPublished) << published[0];
  }
}

TEST(AssemblyModes, AreTwoForAFourBarAndTheGivenOneComesFirst) {
  const KinematicTree tree = TreeOf("four-bar", {"main"});
  const VectorXd q = StartCoordinates(tree);
  const AssemblyModes found = FindAssemblyModes(tree, HoldingJoint(tree, "main"), q);
  ASSERT_EQ(found.modes.size(), 2U) << found.BriefReport();
  EXPECT_LT((found.modes[0].q - q).norm(), 1e-9);
  EXPECT_EQ(found.modes[0].found + found.modes[1].found, found.converged);
}

TEST(AssemblyModes, OutsideTheLimitsOfAJointDoNotCount) {
  Mechanism mechanism = Example("four-bar");
  const KinematicTree free = TreeOf("four-bar", {"main"});
  const AssemblyModes both =
      FindAssemblyModes(free, HoldingJoint(free, "main"), StartCoordinates(free));
  ASSERT_EQ(both.modes.size(), 2U);
  // Limits about the first mode, at a joint of the tree and at the cut one.
  for (size_t j = 0; j < mechanism.joints.size(); ++j) {
    if (mechanism.joints[j].name == "main") continue;
    Mechanism limited = mechanism;
    const double start = limited.joints[j].start[0];
    limited.joints[j].lower[0] = start - 0.1;
    limited.joints[j].upper[0] = start + 0.1;
    const KinematicTree tree = BuildKinematicTree(limited, {{FindJoint(limited, "main")}, {}});
    AssemblyModesOptions options = HoldingJoint(tree, "main");
    EXPECT_EQ(FindAssemblyModes(tree, options, StartCoordinates(tree)).modes.size(), 1U)
        << limited.joints[j].name;
    options.joint_limits = false;
    EXPECT_EQ(FindAssemblyModes(tree, options, StartCoordinates(tree)).modes.size(), 2U);
  }
}

TEST(AssemblyModes, AreElbowUpAndElbowDownForAnArmHeldAtAPoint) {
  const KinematicTree tree = TreeOf("two-link-arm");
  AssemblyModesOptions options;
  options.patience = 200;
  options.hand = HandPose{GraspFrameOf(tree, FindGrasp(tree.mechanism, "tip")), {}};
  options.hand->X_WH.p << 0.5, 0.3, 0;
  EXPECT_EQ(FindAssemblyModes(tree, options, StartCoordinates(tree)).modes.size(), 2U);
  options.hand->X_WH.p << 0.8, 0.6, 0;  // 1 m away, 0.1 m out of reach
  const AssemblyModes none = FindAssemblyModes(tree, options, StartCoordinates(tree));
  EXPECT_TRUE(none.modes.empty());
  EXPECT_TRUE(none.settled);
}

TEST(AssemblyModes, SayWhenTheLinksCanStillMove) {
  const KinematicTree tree = TreeOf("rssr", {"input"});
  AssemblyModesOptions options = HoldingJoint(tree, "input");
  // The rod of an RSSR linkage spins freely between its balls.
  const AssemblyModes loose = FindAssemblyModes(tree, options, StartCoordinates(tree));
  EXPECT_FALSE(loose.modes.front().isolated);
  options.links = {FindLink(tree.mechanism, "rocker")};
  const AssemblyModes found = FindAssemblyModes(tree, options, StartCoordinates(tree));
  EXPECT_EQ(found.modes.size(), 2U);
  EXPECT_TRUE(found.modes[0].isolated && found.modes[1].isolated);
}

TEST(AssemblyModes, AreTheSameForTheSameSeed) {
  const KinematicTree tree = TreeOf("bricard");
  AssemblyModesOptions options;
  options.fixed = {0};
  options.patience = 50;
  const AssemblyModes one = FindAssemblyModes(tree, options, StartCoordinates(tree));
  const AssemblyModes two = FindAssemblyModes(tree, options, StartCoordinates(tree));
  ASSERT_EQ(one.modes.size(), two.modes.size());
  for (size_t i = 0; i < one.modes.size(); ++i) {
    EXPECT_EQ(one.modes[i].q, two.modes[i].q);
    EXPECT_EQ(one.modes[i].found, two.modes[i].found);
  }
}

TEST(AssemblyModes, RefuseToHoldWhatIsNotASingleFreedom) {
  const KinematicTree tree = TreeOf("dietmaier-platform");
  AssemblyModesOptions options;
  options.fixed = {VelocityIndex(tree, FindJoint(tree.mechanism, "ball1"), 0)};
  EXPECT_THROW(FindAssemblyModes(tree, options, StartCoordinates(tree)), std::invalid_argument);
  options.fixed = {};
  options.patience = 0;
  EXPECT_THROW(FindAssemblyModes(tree, options, StartCoordinates(tree)), std::invalid_argument);
}

}  // namespace
}  // namespace vmech
