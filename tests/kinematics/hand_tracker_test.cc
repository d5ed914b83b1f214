// Hands that lead mechanisms along paths, through dead centres, to limits and out of reach.

#include "vmech/kinematics/inverse/hand_tracker.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <utility>

#include "support/examples.h"
#include "vmech/kinematics/inverse/assembly_modes.h"
#include "vmech/kinematics/loops/mobility.h"
#include "vmech/kinematics/loops/unseen_motions.h"
#include "vmech/kinematics/tree/forward_kinematics.h"
#include "vmech/solvers/nullspace.h"

namespace vmech {
namespace {

constexpr double kPi = std::numbers::pi;
// What is left after the last step of a target: the step's square, or a tenth of it if it is a
// Gauss-Newton step.
constexpr double kArrived = 2e-6;
constexpr double kClosed = 1e-10;

static_assert(noexcept(std::declval<HandTracker&>().Advance(std::declval<const Posed&>())));

struct Held {
  Held(const std::string& example, const std::string& link, GraspKind kind)
      : tree(BuildKinematicTree(Example(example))), q(StartCoordinates(tree)) {
    EXPECT_TRUE(Assemble(tree, {}, &q).closed);
    const int index = FindLink(tree.mechanism, link);
    grasp = {tree.NodeOfLink(index), tree.X_node_link(index), kind};
  }
  explicit Held(const std::string& example) : Held(example, 0) {}
  Held(const std::string& example, int index)
      : tree(BuildKinematicTree(Example(example))),
        q(StartCoordinates(tree)),
        grasp(GraspFrameOf(tree, index)) {
    EXPECT_TRUE(Assemble(tree, {}, &q).closed);
  }
  int Coordinate(const std::string& joint) const {
    return CoordinateIndex(tree, FindJoint(tree.mechanism, joint), 0);
  }
  Posed Start() const { return InverseKinematics(tree, grasp).GraspPose(q); }

  KinematicTree tree;
  VectorXd q;
  GraspFrame grasp;
};

/// Closed poses along a smooth motion of the independent coordinates.
std::vector<VectorXd> Motion(const KinematicTree& tree, const VectorXd& q_start, int poses) {
  const Mobility mobility = AnalyseMobility(tree, q_start);
  const CoordinatePartition partition = PartitionAtPose(tree, mobility.q_general);
  AssemblyOptions options;
  options.fixed = partition.driven;
  std::vector<VectorXd> motion{q_start};
  for (int k = 1; k < poses; ++k) {
    VectorXd dq = VectorXd::Zero(tree.nv), q = motion.back();
    double rate = 0.006;  // [rad], of each characteristic length
    for (int v : partition.driven) dq[v] = rate * std::cos(0.02 * k) * std::min(1.0, tree.length);
    MoveCoordinates(tree, dq, &q);
    if (!Assemble(tree, options, &q).closed) break;
    motion.push_back(q);
  }
  return motion;
}

class EveryHeldExample : public testing::TestWithParam<std::string> {};

TEST_P(EveryHeldExample, FollowsAHandThatMovesAsTheMechanismCan) {
  const Held held(GetParam());
  HandTracker tracker(held.tree, held.grasp, held.q);
  InverseKinematics pose(held.tree, held.grasp);
  const std::vector<VectorXd> motion = Motion(held.tree, held.q, 400);
  ASSERT_GT(motion.size(), 50U);
  for (const VectorXd& q : motion) {
    const Posed X_WH = pose.GraspPose(q);
    ASSERT_EQ(tracker.Advance(X_WH), TrackStatus::kFollowed);
    const Vector3d off = X_WH.p - pose.GraspPose(tracker.q()).p;
    ASSERT_LT(off.norm(), kArrived * held.tree.length);
  }
  EXPECT_LE(tracker.summary().worst_closure * held.tree.length, kClosed);
}

TEST_P(EveryHeldExample, ClosesItsLoopsUnderAHandThatPulls) {
  const Held held(GetParam());
  HandTracker tracker(held.tree, held.grasp, held.q);
  InverseKinematics pose(held.tree, held.grasp);
  int k = 0;
  for (const VectorXd& q : Motion(held.tree, held.q, 400)) {
    Posed X_WH = pose.GraspPose(q);
    ++k;
    const Vector3d pull(std::sin(0.02 * k), std::sin(0.03 * k), std::sin(0.01 * k));
    X_WH.p += 0.05 * held.tree.length * pull;
    (void)tracker.Advance(X_WH);
  }
  const TrackSummary& summary = tracker.summary();
  EXPECT_LE(summary.worst_closure * held.tree.length, kClosed);
  EXPECT_EQ(summary.held(), 0) << summary.BriefReport();
  EXPECT_GE(summary.followed, 0.95 * static_cast<double>(summary.targets)) << summary.BriefReport();
}

TEST_P(EveryHeldExample, EndsWhereTheExactSolverDoesWhenTheHandStops) {
  const Held held(GetParam());
  TrackOptions options;
  options.step_tolerance = 1e-14;  // on to the end
  HandTracker tracker(held.tree, held.grasp, held.q, options);
  InverseKinematics problem(held.tree, held.grasp);
  Posed X_WH = held.Start();
  X_WH.p += 0.03 * held.tree.length * Vector3d(1, -0.5, 0.7);
  for (int i = 0; i < 30; ++i) (void)tracker.Advance(X_WH);
  problem.SetTarget(X_WH);
  NullspaceOptions exact;
  exact.stopping = {1e-13, 1e-12, 500};
  const Summary summary = Solve(problem, exact, held.q);
  const Posed a = problem.GraspPose(tracker.q()), b = problem.GraspPose(summary.x);
  EXPECT_LT((a.p - b.p).norm(), 1e-8 * held.tree.length);
  EXPECT_LT((a.R - b.R).norm(), 1e-8);
  // Multipliers of redundant rows are told apart by what they do alone.
  MatrixXd C(held.tree.rows, held.tree.nv);
  problem.Evaluate(summary.x, nullptr, nullptr, nullptr, &C);
  EXPECT_LT((C.transpose() * (tracker.multipliers() - summary.multipliers)).norm(), 1e-7);
}

INSTANTIATE_TEST_SUITE_P(Examples, EveryHeldExample,
                         testing::Values("crank", "two-link-arm", "slider-crank", "four-bar",
                                         "rssr", "rsup", "spherical-four-bar", "bennett", "bricard",
                                         "stewart-gough", "n-window-four-bar", "delta-robot",
                                         "square-four-bar", "marghitu-slider-crank",
                                         "modelica-four-bar", "door-on-two-hinges",
                                         "dietmaier-platform", "manseur-doty", "stewart-gough-sps",
                                         "redundant-arm"),
                         [](const auto& info) { return TestName(info.param); });

// The nearest point of a circle is on the line to its centre. A hand at twice the radius and more
// turns the crank against each Gauss-Newton step.
TEST(HandTracker, IsAtTheNearestPoseHoweverFarTheHandIsFromIt) {
  const Held held("crank", 0);
  for (const double distance : {0.03, 0.15, 0.31, 0.59, 0.61, 1.0, 3.0}) {
    HandTracker tracker(held.tree, held.grasp, held.q);
    Posed X_WH = held.Start();
    for (int k = 0; k <= 400; ++k) {
      const double angle = held.q[0] + 2e-3 * std::min(k, 200);
      X_WH.p = distance * Vector3d(std::cos(angle), std::sin(angle), 0);
      ASSERT_EQ(tracker.Advance(X_WH), TrackStatus::kFollowed);
      ASSERT_NEAR(tracker.q()[0], angle, kArrived) << distance << " m from the hinge, target " << k;
    }
  }
}

TEST(HandTracker, HoldsASliderCrankThroughItsDeadCentreOnTheSideWhereItWas) {
  const Held held("slider-crank", "slider", GraspKind::kPoint);
  const double dead_centre = 0.2;  // crank 50 mm and rod 150 mm in line [m]
  HandTracker tracker(held.tree, held.grasp, held.q);
  const int crank = held.Coordinate("main");
  Posed X_WH = held.Start();
  for (int k = 0; k < 4000; ++k) {
    X_WH.p.x() = dead_centre - 0.01 + 0.015 * std::sin(0.005 * k + 0.2);  // 5 mm beyond it
    (void)tracker.Advance(X_WH);
    ASSERT_GT(std::sin(tracker.q()[crank]), 0) << "target " << k;
    if (k < 20) continue;  // it catches up
    const double nearest = std::min(dead_centre, X_WH.p.x());
    EXPECT_NEAR(tracker.kinematics().GraspPose(tracker.q()).p.x(), nearest, 1e-5) << k;
  }
  EXPECT_GT(tracker.summary().dead_centre, 0);
  EXPECT_EQ(tracker.summary().jumps, 0);
  EXPECT_EQ(tracker.summary().lost, 0);
}

TEST(HandTracker, HoldsACrankRockerThatIsPushedAtItsRocker) {
  // The rocker swings between the poses in which crank and coupler are in line.
  Held held("four-bar", "rocker", GraspKind::kRigid);
  const int crank = held.Coordinate("main");
  HandTracker tracker(held.tree, held.grasp, held.q);
  InverseKinematics pose(held.tree, held.grasp);
  const Posed start = held.Start();
  // About the pivot, which is where the rocker's drawing frame has its z axis.
  const int joint = FindJoint(held.tree.mechanism, "rocker_pivot");
  const JointPlacement& place = held.tree.placements[joint];
  const Posed X_WP = place.first_node < 0 ? place.X_AF : Posed{};
  double last = tracker.q()[crank], farthest = 0;
  for (int k = 0; k < 6000; ++k) {
    const double angle = 1.2 * std::sin(0.002 * k);
    const Eigen::AngleAxisd turn(angle, Vector3d::UnitZ());
    const Posed X_turn{X_WP.R * turn.toRotationMatrix() * X_WP.R.transpose(), Vector3d::Zero()};
    const Posed about{X_turn.R, X_WP.p - X_turn.R * X_WP.p};
    (void)tracker.Advance(about * start);
    const double now = tracker.q()[crank];
    farthest = std::max(farthest, std::abs(now - last));
    last = now;
  }
  EXPECT_GT(tracker.summary().dead_centre, 0) << tracker.summary().BriefReport();
  EXPECT_EQ(tracker.summary().jumps, 0);
  EXPECT_LT(farthest, 0.3);
  // Back where it began: 6000 targets make 1.9 swings, the last ends at sin(12).
  for (int k = 0; k < 200; ++k) (void)tracker.Advance(start);
  EXPECT_NEAR(tracker.q()[crank], held.q[crank], 1e-5);
}

/// The RSSR linkage held by its rocker, with the ball at the rocker or with a universal joint that
/// keeps the rod from spinning.
struct SkewRocker {
  explicit SkewRocker(bool spins) : tree(BuildKinematicTree(Linkage(spins))) {
    q = StartCoordinates(tree);
    AssemblyOptions assembly;
    for (const char* joint : {"input", "output"}) {
      assembly.fixed.push_back(VelocityIndex(tree, FindJoint(tree.mechanism, joint), 0));
    }
    if (spins) assembly.fixed.pop_back();
    EXPECT_TRUE(Assemble(tree, assembly, &q).closed);
    grasp = GraspFrameOf(tree, 1);
    start = InverseKinematics(tree, grasp).GraspPose(q);
    const JointPlacement& place = tree.placements[FindJoint(tree.mechanism, "output")];
    X_WP = place.X_AF;
  }
  static Mechanism Linkage(bool spins) {
    Mechanism mechanism = Example("rssr");
    if (spins) return mechanism;
    // The cross: one axis square to the rod, the other along the axis of the rocker.
    const int b = FindJoint(mechanism, "ball_b");
    const Joint ball = mechanism.joints[b];
    const auto anchor = [&](const AnchorId& end) -> Posed& {
      return mechanism.links[end.link].anchors[end.anchor].X_LA;
    };
    anchor(ball.first).R = AxesFromZX(Vector3d::UnitX(), Vector3d::UnitZ());
    anchor(ball.second).R = AxesFromZX(-Vector3d::UnitY(), Vector3d::UnitX());
    mechanism.joints[b] = MakeJoint("ball_b", JointType::kUniversal, ball.first, ball.second);
    return mechanism;
  }
  Posed RockerTurned(double angle) const {
    const Eigen::AngleAxisd turn(angle, Vector3d::UnitZ());
    const Matrix3d R = X_WP.R * turn.toRotationMatrix() * X_WP.R.transpose();
    return Posed{R, X_WP.p - R * X_WP.p} * start;
  }
  double Crank(const VectorXd& at) const {
    return at[CoordinateIndex(tree, FindJoint(tree.mechanism, "input"), 0)];
  }

  KinematicTree tree;
  VectorXd q;
  GraspFrame grasp;
  Posed start, X_WP;
};

TEST(HandTracker, HoldsALinkageWhoseRodSpinsAsOneWhoseRodDoesNot) {
  const SkewRocker pinned(false), spinning(true);
  for (const double spin : {0.0, 0.7, 2.0, -1.3}) {
    VectorXd q = spinning.q;
    InverseKinematics problem(spinning.tree, spinning.grasp);
    MoveCoordinates(spinning.tree, spin * FindUnseenMotions(&problem, q).basis.col(0), &q);
    ASSERT_TRUE(Assemble(spinning.tree, {}, &q).closed);
    HandTracker reference(pinned.tree, pinned.grasp, pinned.q);
    HandTracker tracker(spinning.tree, spinning.grasp, q);
    double swing = 0;
    for (int k = 0; k < 3000; ++k) {
      // Through both dead centres of the rocker, and beyond; there the pose is free to 0.03 rad.
      const double angle = 1.3 * std::sin(0.004 * k);
      (void)reference.Advance(pinned.RockerTurned(angle));
      (void)tracker.Advance(spinning.RockerTurned(angle));
      const double crank = spinning.Crank(tracker.q());
      ASSERT_NEAR(crank, pinned.Crank(reference.q()), 0.05) << "target " << k << ", spin " << spin;
      swing = std::max(swing, std::abs(crank - spinning.Crank(q)));
    }
    EXPECT_GT(swing, 1);
    EXPECT_GT(tracker.summary().dead_centre, 0) << tracker.summary().BriefReport();
    EXPECT_EQ(tracker.summary().jumps + tracker.summary().lost, 0)
        << tracker.summary().BriefReport();
    for (int k = 0; k < 200; ++k) (void)tracker.Advance(spinning.start);
    EXPECT_NEAR(spinning.Crank(tracker.q()), spinning.Crank(q), 1e-5);
  }
}

TEST(HandTracker, LeavesAnArmToSpareAtRestWhereTheHandIs) {
  const Held held("redundant-arm");
  HandTracker tracker(held.tree, held.grasp, held.q);
  const Posed start = held.Start();
  for (int k = 0; k < 2000; ++k) {
    Posed X_WH = start;
    X_WH.p += 0.05 * Vector3d(std::sin(0.01 * k), std::sin(0.02 * k), std::cos(0.01 * k) - 1);
    ASSERT_EQ(tracker.Advance(X_WH), TrackStatus::kFollowed) << "target " << k;
  }
  const VectorXd there = tracker.q();
  for (int k = 0; k < 1000; ++k) (void)tracker.Advance(tracker.kinematics().target());
  EXPECT_LT((tracker.q() - there).norm(), 1e-5);
}

TEST(HandTracker, StaysAtTheLimitsOfJointsAndComesBack) {
  Mechanism mechanism = Example("two-link-arm");
  mechanism.joints[1].lower[0] = 0.5;
  mechanism.joints[1].upper[0] = 1.5;
  const KinematicTree tree = BuildKinematicTree(mechanism);
  const VectorXd q = StartCoordinates(tree);
  const GraspFrame grasp = GraspFrameOf(tree, 0);
  HandTracker tracker(tree, grasp, q);
  const Posed start = InverseKinematics(tree, grasp).GraspPose(q);
  bool at_lower = false, at_upper = false;
  for (int k = 0; k <= 2000; ++k) {
    Posed X_WH = start;
    X_WH.p *= 1 + 0.6 * std::sin(2 * kPi * k / 2000);
    (void)tracker.Advance(X_WH);
    const double elbow = tracker.q()[1];
    ASSERT_GE(elbow, 0.5);
    ASSERT_LE(elbow, 1.5);
    at_lower |= elbow == 0.5;
    at_upper |= elbow == 1.5;
  }
  EXPECT_TRUE(at_lower && at_upper);
  EXPECT_LT((tracker.q() - q).norm(), 1e-5);
  EXPECT_EQ(tracker.summary().held(), 0) << tracker.summary().BriefReport();
}

TEST(HandTracker, ReachesForAHandBeyondTheWorkspaceWithItsElbowOnOneSide) {
  const Held held("two-link-arm");
  HandTracker tracker(held.tree, held.grasp, held.q);
  InverseKinematics pose(held.tree, held.grasp);
  const double reach = 0.9;
  for (int k = 0; k < 6000; ++k) {
    const double angle = 0.5 + 0.003 * k, radius = 0.8 + 0.25 * std::sin(0.004 * k);
    Posed X_WH;
    X_WH.p << radius * std::cos(angle), radius * std::sin(angle), 0;
    (void)tracker.Advance(X_WH);
    ASSERT_GT(tracker.q()[1], -1e-9) << "target " << k;
    const double off = (X_WH.p - pose.GraspPose(tracker.q()).p).norm();
    EXPECT_LT(off, std::max(0.0, radius - reach) + (k > 20 ? 0.01 : 1)) << "target " << k;
  }
  EXPECT_EQ(tracker.summary().jumps, 0) << tracker.summary().BriefReport();
}

TEST(HandTracker, RefusesToJumpToTheOtherAssemblyMode) {
  const Held held("four-bar");
  AssemblyModesOptions options;
  const int main = FindJoint(held.tree.mechanism, "main");
  options.fixed = {VelocityIndex(held.tree, main, 0)};
  options.patience = 100;
  const AssemblyModes modes = FindAssemblyModes(held.tree, options, held.q);
  ASSERT_EQ(modes.modes.size(), 2U);
  HandTracker tracker(held.tree, held.grasp, held.q);
  InverseKinematics pose(held.tree, held.grasp);
  for (int k = 0; k < 300; ++k) (void)tracker.Advance(pose.GraspPose(modes.modes[1].q));
  // The hand comes back, and finds the mechanism where it left it.
  for (int k = 0; k < 300; ++k) (void)tracker.Advance(held.Start());
  for (int i = 0; i < held.q.size(); ++i) {
    EXPECT_NEAR(std::remainder(tracker.q()[i] - held.q[i], 2 * kPi), 0, 1e-5);
  }
  EXPECT_LE(tracker.summary().worst_closure, kClosed);
}

/// Three axes through one point, about z, y and z: the outer ones are in line at q[1] = 0.
Mechanism Wrist() {
  Mechanism wrist;
  wrist.links = {{"ground", {}, {}}};
  const Vector3d axes[] = {Vector3d::UnitZ(), Vector3d::UnitY(), Vector3d::UnitZ()};
  for (int i = 0; i < 3; ++i) {
    Posed X_LA;
    X_LA.R = AxesFromZX(axes[i], Vector3d::UnitX());
    wrist.links[i].anchors.push_back({"out", X_LA});
    const int out = static_cast<int>(wrist.links[i].anchors.size()) - 1;
    wrist.links.push_back({"link" + std::to_string(i), {}, {{"in", X_LA}}});
    wrist.joints.push_back(
        MakeJoint("joint" + std::to_string(i), JointType::kRevolute, {i, out}, {i + 1, 0}));
  }
  wrist.grasps = {{"hand", 3, Posed{}, GraspKind::kRigid}};
  return wrist;
}

TEST(HandTracker, GoesStraightThroughAWristWhoseAxesComeInLine) {
  const KinematicTree tree = BuildKinematicTree(Wrist());
  InverseKinematics pose(tree, GraspFrameOf(tree, 0));
  HandTracker tracker(tree, GraspFrameOf(tree, 0), Eigen::Vector3d(0.3, 0.5, 0.4));
  VectorXd q(3);
  for (int k = 1; k <= 100; ++k) {
    q << 0.3 + 0.002 * k, 0.5 - 0.01 * k, 0.4 - 0.001 * k;
    (void)tracker.Advance(pose.GraspPose(q));
    ASSERT_LT((tracker.q() - q).lpNorm<Eigen::Infinity>(), 0.05) << "target " << k;
  }
  EXPECT_LT((tracker.q() - q).lpNorm<Eigen::Infinity>(), kArrived);  // q[1] = -0.5
  EXPECT_LE(tracker.summary().held(), 2) << tracker.summary().BriefReport();
}

TEST(HandTracker, FollowsOnItsOwnSideAHandThatTouchesTheEdgeOfTheWorkspace) {
  // The elbow of the path goes through the stretched pose: the hand comes to the edge of the
  // workspace and back, and the tracker's elbow stays on its side.
  const Held held("two-link-arm");
  InverseKinematics pose(held.tree, held.grasp);
  VectorXd q = held.q;
  q << 0.5, 0.31;
  HandTracker tracker(held.tree, held.grasp, q);
  for (int k = 1; k <= 30; ++k) {
    q << 0.5 + 0.01 * k, 0.31 - 0.02 * k;
    (void)tracker.Advance(pose.GraspPose(q));
    const Posed X_WG = pose.GraspPose(tracker.q());
    EXPECT_LT((X_WG.p - pose.GraspPose(q).p).norm(), 1e-5) << "target " << k;
    ASSERT_GT(tracker.q()[1], 0) << "target " << k;
  }
  EXPECT_NEAR(tracker.q()[1], -q[1], 1e-5);
}

TEST(HandTracker, CatchesUpWithAHandThatIsFarAway) {
  const Held held("crank");
  TrackOptions options;
  options.max_move = 0.1;
  HandTracker tracker(held.tree, held.grasp, held.q, options);
  VectorXd q = held.q;
  q[0] += 1;
  const Posed X_WH = InverseKinematics(held.tree, held.grasp).GraspPose(q);
  for (int k = 1; k < 9; ++k) {
    const double before = tracker.q()[0];
    ASSERT_EQ(tracker.Advance(X_WH), TrackStatus::kCatchingUp) << k;
    ASSERT_LE(tracker.q()[0] - before, 0.1 + 1e-12);
  }
  for (int k = 0; k < 5; ++k) (void)tracker.Advance(X_WH);
  EXPECT_NEAR(tracker.q()[0], q[0], kArrived);
}

TEST(HandTracker, HoldsItsPoseWhereTheHandIsNotANumber) {
  const Held held("slider-crank");
  HandTracker tracker(held.tree, held.grasp, held.q);
  Posed X_WH = held.Start();
  X_WH.p.x() = NAN;
  EXPECT_EQ(tracker.Advance(X_WH), TrackStatus::kLost);
  EXPECT_EQ(tracker.q(), held.q);
  EXPECT_EQ(tracker.Advance(held.Start()), TrackStatus::kFollowed);
}

TEST(HandTracker, RefusesOpenLoopsAndOptionsOutOfRange) {
  Held held("four-bar");
  TrackOptions options;
  options.steps = 0;
  EXPECT_THROW(HandTracker(held.tree, held.grasp, held.q, options), std::invalid_argument);
  held.q[0] += 0.1;
  EXPECT_THROW(HandTracker(held.tree, held.grasp, held.q), std::invalid_argument);
}

}  // namespace
}  // namespace vmech
