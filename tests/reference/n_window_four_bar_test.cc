#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "reference_case.h"
#include "support/windows.h"

namespace vmech::reference::n_window_four_bar_test {
namespace {

/// N-window four-bar linkage, benchmark A02 of the IFToMM library of multibody problems: 2N + 1
/// bars of 1 m and 1 kg; the corner b0 starts at 1 m/s. As long as the windows stay parallelograms
///   A th'' = -B g cos th,  A = (N + 1)/3 + N,  B = (N + 1)/2 + N,  b0 = (cos th, sin th);
/// integrated with 40 digits (EXUDYN publishes the same at 10 s for N = 2).
struct Row {
  int windows;
  double t, x, y, vx, vy;  // of b0 [s, m, m/s]
};
constexpr Row kRows[] = {
    {1, 0.1, 0.101795935817220357, 0.994805301278142744, 1.05388529252090135,
     -0.107841443404386181},
    {1, 1.0, -0.260712675183650356, -0.965416439159073168, -6.63780949612175144,
     1.79255397038893056},
    {1, 10.0, 0.478385057760970559, 0.878150178791209301, 1.72726407554715364,
     -0.940952179371515644},
    {2, 0.1, 0.101741115568441879, 0.994810909370664749, 1.05223453927574934,
     -0.107613934323745456},
    {2, 1.0, -0.195020301949435094, -0.980799205662173833, -6.67667803688115807,
     1.32757832516048721},
    {2, 10.0, 0.328458111540815379, 0.944518538178600962, 1.42305147020694412,
     -0.494868845487042959},
    {40, 0.1, 0.101676443398748278, 0.994817521386601402, 1.05028756378670514,
     -0.107345821455700016},
    {40, 1.0, -0.115356880632109898, -0.993324111300450186, -6.66998752394177159,
     0.774600098662343315},
    {40, 10.0, 0.18051222668672839, 0.983572740582311575, 1.14844127746941413,
     -0.210770066779423932},
};
constexpr double kGravity = 9.81;
constexpr double kTolerance = 1e-10;  // of the weight of all bars; rounding, added up over N loops

class NWindowFourBar : public testing::TestWithParam<Row> {
 protected:
  double Inertia() const { return (row_.windows + 1) / 3. + row_.windows; }
  double MassMoment() const { return (row_.windows + 1) / 2. + row_.windows; }
  double Weight() const { return (2 * row_.windows + 1) * kGravity; }

  const Row row_ = GetParam();
  const double rate_ = row_.x * row_.vy - row_.y * row_.vx;
  const double acceleration_ = -MassMoment() / Inertia() * kGravity * row_.x;
  const double lean_ = std::atan2(row_.y, row_.x) - std::numbers::pi / 2;
  const Mechanism windows_ = Windows(row_.windows, lean_);
  const PoseLoads loads_ = LoadsAt(windows_, {{"a0", {lean_, rate_, acceleration_}}});
};

TEST_P(NWindowFourBar, FallsFreelyByTheEquationOfOneFreedom) {
  EXPECT_NEAR(loads_.drives[0].force, 0, kTolerance * Weight());
}

TEST_P(NWindowFourBar, CornerMovesAsPublished) {
  const LinkMotion& post = loads_.links[1];
  const Vector3d p = post.X_WL * Vector3d(0, 1, 0);
  const Vector3d v = post.v + post.w.cross(post.X_WL.R * Vector3d(0, 1, 0));
  EXPECT_LT((p - Vector3d(row_.x, row_.y, 0)).norm(), kTolerance);
  EXPECT_LT((v - Vector3d(row_.vx, row_.vy, 0)).norm(), 10 * kTolerance);
}

TEST_P(NWindowFourBar, GroundCarriesWeightAndInertiaOfAllBars) {
  Vector3d from_ground = Vector3d::Zero();
  for (int i = 0; i <= row_.windows; ++i) {
    from_ground += OnSecond_W(windows_, loads_, Numbered("a", i)).force;
  }
  const Vector3d corner(row_.x, row_.y, 0), across(-row_.y, row_.x, 0);
  const Vector3d momentum_rate = MassMoment() * (acceleration_ * across - rate_ * rate_ * corner);
  EXPECT_LT((from_ground - momentum_rate - Vector3d(0, Weight(), 0)).norm(), kTolerance * Weight());
}

INSTANTIATE_TEST_SUITE_P(AlongTheMotion, NWindowFourBar, testing::ValuesIn(kRows));

TEST(NWindowFourBar, ShippedExampleIsTheSameMechanism) {
  const MotionSample state = {-0.3, -1.5, 2};
  const Mechanism shipped = LedTo(Example("n-window-four-bar"), "a0", -0.3);
  const double force = LoadsAt(shipped, {{"a0", state}}).drives[0].force;
  EXPECT_NEAR(force, LoadsAt(Windows(2, -0.3), {{"a0", state}}).drives[0].force, 1e-10);
}

}  // namespace
}  // namespace vmech::reference::n_window_four_bar_test
