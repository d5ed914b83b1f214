#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "reference_case.h"

#include "vmech/dynamics/loads/load_result.h"
#include "vmech/dynamics/loads/run_load_study.h"

namespace vmech::reference::slider_crank_test {
namespace {

constexpr double kExact = 1e-12;  // published as exact surds; only rounding is left

/// D. B. Marghitu, Mechanisms and Robots Analysis with MATLAB, chapter 4: 45 degrees, 1 rad/s, a
/// force of 100 N on the slider.
class MarghituSliderCrank : public testing::Test {
 protected:
  MarghituSliderCrank() {
    LoadStudy study = StudyAt(slider_crank_, {{"main", {std::numbers::pi / 4, 1, 0}}});
    study.external = {Force(slider_crank_, "slider", {0, 0, 0}, {100, 0, 0})};
    loads_ = RunLoadStudy(study).poses.front();
  }

  void ExpectForce(const char* joint, double x, double y) const {
    const Vector3d force = OnSecond_W(slider_crank_, loads_, joint).force;
    EXPECT_NEAR(force.x(), x, kExact * 100) << joint;
    EXPECT_NEAR(force.y(), y, kExact * 100) << joint;
  }

  const Mechanism slider_crank_ = Example("marghitu-slider-crank");
  const double root2_ = std::numbers::sqrt2;
  PoseLoads loads_;
};

TEST_F(MarghituSliderCrank, CrankPinCarriesThePublishedForce) {
  ExpectForce("pin", -(400 + 7 * root2_) / 4, 5 * (84 + root2_) / 4);
}

TEST_F(MarghituSliderCrank, OtherForcesFollowFromTheBalanceOfEachLink) {
  ExpectForce("main", -102.82842712474618, 116.41421356237308);
  ExpectForce("wrist", -101.41421356237309, 97.12132034355963);
  ExpectForce("guide", 0, -87.12132034355963);
  EXPECT_NEAR(loads_.drives[0].force, 151.49242404917499, kExact * 151);
}

/// idaSlCrank of the SUNDIALS examples (LLNL/sundials, BSD-3): its printed solution, and the same
/// recomputed to 12 digits with the multipliers of the crank pin.
struct Row {
  double t, q, x, p, q_rate;
  double pin[2];  // force of the rod on the crank [N]
};
constexpr Row kRows[] = {
    {1,
     1.315420570882,
     1.001491807231,
     -0.504973470642,
     -0.50879297691,
     {1.0548152467, -0.5538207267}},
    {2,
     0.579038812049,
     1.380335271961,
     -0.277144095739,
     -0.942187072785,
     {1.4622661985, 0.0649399372}},
    {5,
     -1.429996967647,
     0.939030613578,
     0.51789475649,
     0.054991610538,
     {1.2218087447, 1.0131220401}},
    {10,
     1.27567584865,
     1.02357855898,
     -0.498813049183,
     -0.239914997196,
     {1.1137561583, -0.7625072751}},
};
constexpr double kTolerance = 1e-8;  // of the recomputed table

class SundialsSliderCrank : public testing::TestWithParam<Row> {
 protected:
  SundialsSliderCrank() {
    study_.mechanism = slider_crank_;
    study_ = StudyAt(slider_crank_, {{"main", {row_.q, row_.q_rate, 0}}});
    study_.external = {Force(slider_crank_, "rod", {1, 0, 0}, {1, 0, 0})};
  }

  const Row row_ = GetParam();
  const Mechanism slider_crank_ = LedTo(Example("sundials-slider-crank"), "main", row_.q);
  LoadStudy study_;
};

TEST_P(SundialsSliderCrank, SlideAndRodStandWhereTheTableSays) {
  const PoseLoads loads = RunLoadStudy(study_).poses.front();
  const Matrix3d R_WRod = loads.links[FindLink(slider_crank_, "rod")].X_WL.R;
  EXPECT_NEAR(Position(slider_crank_, loads, "guide"), row_.x, kTolerance);
  EXPECT_NEAR(std::atan2(R_WRod(1, 0), R_WRod(0, 0)), row_.p, kTolerance);
}

TEST_P(SundialsSliderCrank, CrankPinForceOfTheFreeMotionIsTheMultiplier) {
  const double acceleration = FreeAcceleration(study_, "main", row_.q, row_.q_rate);
  study_.drives[0].law = MotionLaw::Uniform(row_.q, row_.q_rate, acceleration);
  const PoseLoads loads = RunLoadStudy(study_).poses.front();
  const Vector3d on_rod = OnSecond_W(slider_crank_, loads, "pin").force;
  EXPECT_NEAR(on_rod.x(), -row_.pin[0], kTolerance);
  EXPECT_NEAR(on_rod.y(), -row_.pin[1], kTolerance);
}

INSTANTIATE_TEST_SUITE_P(AlongTheMotion, SundialsSliderCrank, testing::ValuesIn(kRows));

}  // namespace
}  // namespace vmech::reference::slider_crank_test
