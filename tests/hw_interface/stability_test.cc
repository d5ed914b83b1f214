#include "vmech/hw_interface/safety/stability.h"

#include <gtest/gtest.h>

#include "hw_interface/point_master.h"

namespace vmech::stability_test {
namespace {

/// Whether a spring K with damper B renders a swing that dies out within 20 000 samples.
bool IsStable(const PointOptions& options, double stiffness, double damping) {
  PointMaster master(options);
  master.Configure();
  master.Activate();
  master.x[0] = 1e-3;
  MasterState state, last;
  MasterCommand command;
  command.mode = CommandMode::kWrench;
  const auto period_ns = std::llround(options.period * 1e9);
  double early = 0, late = 0;
  for (int k = 0; k < 20'000; ++k) {
    EXPECT_EQ(master.Read(k * period_ns, &state), IoStatus::kOk);
    if (k == 0) last = state;
    command.F_Ho_D = Wall{stiffness, damping}.Wrench(state, last, options.period);
    EXPECT_EQ(master.Write(command), IoStatus::kOk);
    last = state;
    const double size = std::abs(state.X_DH.p.x());
    if (k < 2'000) early = std::max(early, size);
    if (k >= 18'000) late = std::max(late, size);
    if (size > 1) return false;
  }
  return late < early;
}

/// The largest stable stiffness by bisection.
double SweptStiffness(const PointOptions& options, double damping) {
  double low = 1, high = 1e6;
  while (high / low > 1.002) {
    const double middle = std::sqrt(low * high);
    (IsStable(options, middle, damping) ? low : high) = middle;
  }
  return low;
}

RenderingBounds Bounds(const PointOptions& options, double damping) {
  PointMaster master(options);
  master.Configure();
  return BoundsOf(master.info().linear, options.period, master.info().delay, damping);
}

struct SweepCase {
  double mass, b, B, period;
  int delay;
  double exact;  // by the eigenvalues of the sampled system, computed elsewhere
};

/// Sampled mass and damper with a spring: largest stable stiffness from exact eigenvalues.
const std::array<SweepCase, 6> kSweep{{{0.5, 2, 0, 1e-3, 0, 4002.668},
                                       {0.5, 2, 1, 1e-3, 0, 5992.031},
                                       {0.5, 2, 0, 1e-3, 1, 1334.813},
                                       {0.5, 2, 5, 1e-3, 1, 4620.080},
                                       {1.0, 5, 0, 2e-3, 0, 5008.337},
                                       {0.1, 0.5, 0, 1e-3, 0, 1000.834}}};

TEST(RenderingBounds, GainSweepFindsThemWithin5Percent) {
  for (const SweepCase& c : kSweep) {
    PointOptions options;
    options.mass = c.mass;
    options.damping = c.b;
    options.period = c.period;
    options.delay_periods = c.delay;
    const double swept = SweptStiffness(options, c.B);
    EXPECT_NEAR(swept, c.exact, 0.005 * c.exact);
    EXPECT_NEAR(Bounds(options, c.B).stable_stiffness, swept, 0.05 * swept);
    EXPECT_LE(Bounds(options, c.B).passive_stiffness, 1.01 * swept);
  }
}

TEST(RenderingBounds, DampingCostsStiffnessOnlyIfItMustBePassive) {
  const HandlePhysics handle{0.5, 2, 0, 0, 20};
  const RenderingBounds bounds = BoundsOf(handle, 1e-3, 0, 1);
  EXPECT_NEAR(bounds.passive_stiffness, 2000, 1e-9);
  EXPECT_NEAR(bounds.stable_stiffness, 6000, 1e-9);
  EXPECT_EQ(BoundsOf(handle, 1e-3, 0, 3).passive_stiffness, 0);
}

TEST(RenderingBounds, FrictionMustHoldOneEncoderStep) {
  HandlePhysics handle{0.5, 2, 0.1, 1e-4, 20};
  EXPECT_NEAR(BoundsOf(handle, 1e-3, 0).quiet_stiffness, 2000, 1e-9);  // 2 f_c / D
  handle.coulomb = 1;
  EXPECT_NEAR(BoundsOf(handle, 1e-3, 0).quiet_stiffness, 4000, 1e-9);  // 2 b / T
}

TEST(LimitedGains, SpendTheDampingOfTheDeviceOnce) {
  DeviceInfo info;
  info.linear = {0.5, 2, 0, 0, 20};
  info.angular = {0.005, 0.02, 0, 0, 1};
  RenderingGains wanted;
  wanted.stiffness << 1e6, 100, -5, 1e6, 1, std::nan("");
  wanted.damping << 0.5, 0, 9, 0, 0, 0;
  const RenderingGains gains = LimitedGains(info, wanted);
  EXPECT_NEAR(gains.stiffness[0], 3000, 1e-9);
  EXPECT_EQ(gains.stiffness[1], 100);
  EXPECT_EQ(gains.stiffness[2], 0);
  EXPECT_EQ(gains.damping[2], 2);
  EXPECT_NEAR(gains.stiffness[3], 40, 1e-9);
  EXPECT_EQ(gains.stiffness[4], 1);
  EXPECT_EQ(gains.stiffness[5], 0);
}

TEST(BoundsReport, SaysWhatTheDeviceAllows) {
  DeviceInfo info;
  info.linear = {0.5, 2, 0, 0, 20};
  EXPECT_EQ(BoundsReport(info).substr(0, BoundsReport(info).find('\n')),
            "translation: passive up to K = 4000 N/m or B = 2 N s/m (no resolution stated); own "
            "damping 2, T = 1 ms, delay 0 ms");
}

}  // namespace
}  // namespace vmech::stability_test
