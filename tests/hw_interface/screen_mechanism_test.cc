#include "vmech/hw_interface/screen/screen_mechanism.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <memory>
#include <stdexcept>
#include <thread>

#include "support/examples.h"
#include "vmech/base/triple_buffer.h"
#include "vmech/kinematics/loops/assembled_mechanism.h"

namespace vmech::screen_mechanism_test {
namespace {

ScreenMechanism OnScreen(const std::string& example) {
  return ScreenMechanism(RequireAssembled(Example(example)).mechanism);
}

/// What the joints of the ground and the hand put on all that moves [N], world axes.
Vector3d Carried(const ScreenMechanism& screen, const ScreenState& state) {
  const Mechanism& m = screen.mechanism();
  Vector3d sum = state.force;
  for (size_t j = 0; j < m.joints.size(); ++j) {
    const Joint& joint = m.joints[j];
    const bool from = joint.first.link == m.ground, to = joint.second.link == m.ground;
    if (from == to) continue;
    const Matrix3d R_WF = state.links[joint.first.link].R * m.anchor(joint.first).X_LA.R;
    sum += (from ? 1.0 : -1.0) * (R_WF * state.wrenches[j].force);
  }
  return sum;
}

double MovingMass(const Mechanism& m) {
  double mass = 0;
  for (size_t i = 0; i < m.links.size(); ++i) {
    if (static_cast<int>(i) != m.ground) mass += m.links[i].mass_properties.mass;
  }
  return mass;
}

class HeldOnScreen : public testing::TestWithParam<const char*> {};

TEST_P(HeldOnScreen, GroundAndHandCarryTheWholeWeight) {
  ScreenMechanism screen = OnScreen(GetParam());
  const Mechanism& m = screen.mechanism();
  const int link = m.grasps.empty() ? 1 : m.grasps.front().link;
  screen.Grab(link, m.grasps.empty() ? Vector3d::Zero() : m.grasps.front().X_LG.p);
  screen.Advance(3000);
  const ScreenState state = screen.State();
  ASSERT_EQ(state.mode, ScreenMode::kHeld);
  const auto largest =
      std::max_element(state.rates.begin(), state.rates.end(),
                       [](double a, double b) { return std::abs(a) < std::abs(b); });
  ASSERT_LT(std::abs(*largest), 1e-6) << "still moving";
  const Vector3d weight = MovingMass(m) * m.gravity_W;
  EXPECT_LT((Carried(screen, state) + weight).norm(), 1e-6 * weight.norm());
  EXPECT_LT((state.point - state.target).norm(), 6e-4 * screen.tree().length);
  EXPECT_LT(state.closure, 1e-9);
}

INSTANTIATE_TEST_SUITE_P(Examples, HeldOnScreen,
                         testing::Values("crank", "four-bar", "slider-crank"));

TEST(ScreenMechanism, SlidesAlongTheAssemblyBranch) {
  ScreenMechanism screen = OnScreen("four-bar");
  screen.Slide(0, 0, 2.0);
  const ScreenState state = screen.State();
  EXPECT_NEAR(state.coordinates[0], 2.0, 1e-12);
  EXPECT_FALSE(state.stopped);
  EXPECT_EQ(state.mode, ScreenMode::kFrozen);
  EXPECT_TRUE(state.wrenches.empty());
  // The coupler's end stays above the line from crank pin to rocker pivot.
  const Vector3d pin = state.links[2] * Vector3d::Zero(),
                 end = state.links[2] * Vector3d(1.2, 0, 0);
  EXPECT_NEAR((end - Vector3d(1.1, 0, 0)).norm(), 0.75, 1e-12);
  EXPECT_NEAR((pin - Vector3d(0.5 * std::cos(2.0), 0.5 * std::sin(2.0), 0)).norm(), 0, 1e-12);
  EXPECT_GT((Vector3d(1.1, 0, 0) - pin).cross(end - pin).z(), 0);
}

TEST(ScreenMechanism, StopsWhereTheLoopsEnd) {
  ScreenMechanism screen = OnScreen("four-bar");
  screen.Slide(3, 0, 6.0);  // the rocker does not turn around
  const ScreenState state = screen.State();
  EXPECT_TRUE(state.stopped);
  EXPECT_LT(state.closure, 1e-12);
  // Crank and coupler in line: the rocker's end is 1.7 or 0.7 m from the main bearing.
  const double reach = (state.links[2] * Vector3d(1.2, 0, 0)).norm();
  EXPECT_LT(std::min(std::abs(reach - 1.7), std::abs(reach - 0.7)), 1e-3);
}

TEST(ScreenMechanism, SwingsWithoutLosingOrWinningWeight) {
  ScreenMechanism screen = OnScreen("crank");
  screen.Swing();
  double lowest = 0;
  for (int i = 0; i < 200; ++i) {
    screen.Advance(5);
    lowest = std::min(lowest, screen.State().links[1].R(1, 0));
  }
  EXPECT_NEAR(lowest, -1, 1e-2);  // through the bottom
  screen.Freeze();
  const double angle = screen.State().coordinates[0];
  screen.Advance(100);
  EXPECT_EQ(screen.State().coordinates[0], angle);
  screen.Reset();
  EXPECT_NEAR(screen.State().coordinates[0], 40 * M_PI / 180, 1e-12);
}

TEST(ScreenMechanism, RefusesWhatDoesNotExist) {
  ScreenMechanism screen = OnScreen("four-bar");
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(screen.Grab(0, Vector3d::Zero()), std::invalid_argument);
  EXPECT_THROW(screen.Grab(9, Vector3d::Zero()), std::invalid_argument);
  EXPECT_THROW(screen.Grab(1, Vector3d(nan, 0, 0)), std::invalid_argument);
  EXPECT_THROW(screen.Drag(Vector3d(0, nan, 0)), std::invalid_argument);
  EXPECT_THROW(screen.Slide(4, 0, 0), std::invalid_argument);
  EXPECT_THROW(screen.Slide(0, 1, 0), std::invalid_argument);
  EXPECT_THROW(screen.Slide(0, 0, nan), std::invalid_argument);
  EXPECT_EQ(screen.State().mode, ScreenMode::kFrozen);
}

TEST(TripleBuffer, GivesTheNewestWholeValue) {
  struct Pair {
    long a = 0, b = 0;
  };
  TripleBuffer<Pair> buffer{Pair{}};
  std::atomic<bool> over = false;
  std::thread writer([&] {
    for (long i = 1; i <= 200000; ++i) {
      buffer.back() = {i, -i};
      buffer.Publish();
    }
    over = true;
  });
  long last = 0;
  while (!over || buffer.Take()) {
    if (!buffer.Take()) continue;
    ASSERT_EQ(buffer.front().a, -buffer.front().b);
    ASSERT_GT(buffer.front().a, last);
    last = buffer.front().a;
  }
  writer.join();
  EXPECT_GE(buffer.front().a, last);
  EXPECT_EQ(buffer.front().a, 200000);
  EXPECT_TRUE(buffer.wanted());
}

}  // namespace
}  // namespace vmech::screen_mechanism_test
