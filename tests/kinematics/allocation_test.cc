// The sanitizers bring an allocator of theirs.
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)

#include <gtest/gtest.h>

#include <cmath>

#include "support/count_allocations.h"
#include "support/examples.h"
#include "vmech/kinematics/inverse/hand_tracker.h"

namespace vmech {
namespace {

class FastPath : public testing::TestWithParam<std::string> {};

// The hand strays far enough for every part of the tracker to have its turn.
TEST_P(FastPath, AllocatesNothingWhileItFollowsAHand) {
  const KinematicTree tree = BuildKinematicTree(Example(GetParam()));
  VectorXd q = StartCoordinates(tree);
  ASSERT_TRUE(Assemble(tree, {}, &q).closed);
  const GraspFrame grasp = GraspFrameOf(tree, 0);
  HandTracker tracker(tree, grasp, q);
  const Posed start = tracker.kinematics().GraspPose(q);
  const long before = allocations;
  for (int k = 0; k < 500; ++k) {
    Posed X_WH = start;
    const double far = 0.005 * k * tree.length;
    X_WH.p += far * Vector3d(std::sin(0.1 * k), std::cos(0.1 * k), std::sin(0.3 * k));
    (void)tracker.Advance(X_WH);
  }
  EXPECT_EQ(allocations - before, 0);
  EXPECT_GT(tracker.summary().rescued + tracker.summary().catching_up, 0);
}

INSTANTIATE_TEST_SUITE_P(Examples, FastPath,
                         testing::Values("two-link-arm", "slider-crank", "rssr", "bennett",
                                         "stewart-gough", "stewart-gough-sps", "redundant-arm"),
                         [](const auto& info) { return TestName(info.param); });

}  // namespace
}  // namespace vmech

#endif
