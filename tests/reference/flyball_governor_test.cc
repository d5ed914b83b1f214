#include <gtest/gtest.h>

#include <cmath>

#include "reference_case.h"

namespace vmech::reference::flyball_governor_test {
namespace {

/// Stiff flyball governor, benchmark A05 of the IFToMM library of multibody problems. The table is
/// of Lagrange's equations of the symmetric motion in long double, three step sizes agreeing to 12
/// digits. The same equations stand below: they must meet the table, and driven along their
/// solution the mechanism, with its struts as links, must not need any drive.
using State = Eigen::Matrix<double, 6, 1>;  // spin, slider, rod below the horizontal, their rates

struct Row {
  double t, slider, rod, spin_rate, spin;
};
constexpr Row kRows[] = {
    {0.05, 0.506100897244, 0.516486931215, 6.235040215981, 0.313347930807},
    {0.1, 0.52383647557, 0.496173869076, 6.103717808831, 0.622106681403},
};
constexpr double kDigits = 2e-12;  // of the table
constexpr double kAtRest = 1e-9;   // drive forces, of the weight of 13.9 kg
constexpr double kWeight = 13.9 * 9.81;

State Rates(const State& y) {
  constexpr double kRodMass = 5.3, kMoment = 5.15, kSquare = 5.1;  // sum of m, m u, m u^2
  constexpr double kAcross = 0.3 * 1e-4 / 12;                      // of a rod's section
  constexpr double kStiffness = 8e5, kDamping = 4e4, kSlack = 0.5, kSlider = 3, kRadius = 0.05;
  constexpr double g = 9.81;
  const double c = std::cos(y[2]), s = std::sin(y[2]);
  const double spin_inertia = 0.005 + 5e-6 +
                              2 * (kRadius * kRadius * kRodMass + 2 * kRadius * kMoment * c +
                                   kSquare * c * c + kAcross * (1 + s * s));
  const double spin_inertia_slope = -4 * s * (kRadius * kMoment + (kSquare - kAcross) * c);
  const double height = 1 - 0.5 * s - y[1], length = std::hypot(0.5 * c, height);
  const double by_rod = -(0.25 * c * s + 0.5 * height * c) / length, by_slider = -height / length;
  const double strut =
      kStiffness * (length - kSlack) + kDamping * (by_rod * y[5] + by_slider * y[4]);
  State rates;
  rates << y.tail<3>(), -spin_inertia_slope * y[5] * y[3] / spin_inertia,
      -g - 2 * strut * by_slider / kSlider,
      (0.5 * spin_inertia_slope * y[3] * y[3] + 2 * g * kMoment * c - 2 * strut * by_rod) /
          (2 * (kSquare + kAcross));
  return rates;
}

State StateAt(double t) {
  constexpr double kStep = 2e-5;  // [s]; halving it changes the thirteenth digit
  State y;
  y << 0, 0.5, std::acos(-1.0) / 6, 2 * std::acos(-1.0), 0, 0;
  for (int i = 0; i < std::lround(t / kStep); ++i) {
    const State k1 = Rates(y), k2 = Rates(y + kStep / 2 * k1), k3 = Rates(y + kStep / 2 * k2),
                k4 = Rates(y + kStep * k3);
    y += kStep / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
  }
  return y;
}

class FlyballGovernor : public testing::TestWithParam<Row> {
 protected:
  const State y_ = StateAt(GetParam().t);
};

TEST_P(FlyballGovernor, LagrangesEquationsMeetTheTable) {
  const Row row = GetParam();
  EXPECT_NEAR(y_[0], row.spin, kDigits);
  EXPECT_NEAR(y_[1], row.slider, kDigits);
  EXPECT_NEAR(y_[2], row.rod, kDigits);
  EXPECT_NEAR(y_[3], row.spin_rate, kDigits);
}

TEST_P(FlyballGovernor, NeedsNoDriveAlongThem) {
  const State a = Rates(y_);
  const PoseLoads loads =
      LoadsAt(Example("flyball-governor"), {{"spin", {y_[0], y_[3], a[3]}},
                                            {"slide", {y_[1], y_[4], a[4]}},
                                            {"right_hinge", {y_[2], y_[5], a[5]}},
                                            {"left_hinge", {-y_[2], -y_[5], -a[5]}}});
  for (const DriveSample& drive : loads.drives) EXPECT_NEAR(drive.force, 0, kAtRest * kWeight);
}

INSTANTIATE_TEST_SUITE_P(AlongTheMotion, FlyballGovernor, testing::ValuesIn(kRows));

}  // namespace
}  // namespace vmech::reference::flyball_governor_test
