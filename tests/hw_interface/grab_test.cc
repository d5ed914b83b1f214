/// A hand that closes on a link in full swing.

#include <gtest/gtest.h>

#include "hw_interface/tick_input.h"
#include "support/examples.h"
#include "vmech/hw_interface/masters/simulated_master.h"
#include "vmech/hw_interface/rendering/coupled_tick.h"
#include "vmech/hw_interface/rendering/coupling_choice.h"

namespace vmech::grab_test {
namespace {

constexpr double kPeriod = 1e-3;

class EveryGrab : public testing::TestWithParam<std::string> {
 protected:
  EveryGrab() {
    SimulatedMaster master;
    master.Configure();
    const int grasp = FindGrasp(tree_.mechanism, "handle");
    const CouplingChoice choice =
        ChooseCoupling(tree_, GraspFrameOf(tree_, grasp), q_, master.info(), options_.smoothing);
    options_.coupling = choice.coupling;
    options_.scale = choice.scale;
    tick_ = std::make_unique<CoupledTick>(tree_, grasp, q_, kPeriod, options_);
    channels_.resize(tick_->ChannelNames().size());
  }

  TickOutput Step(const Posed& X_WH, bool held) {
    TickInput input = FreshInput(X_WH, kPeriod);
    input.held = held;
    return tick_->Step(input, channels_);
  }
  /// The hand swings the mechanism, lets go of it and waits.
  void Throw(Random* random) {
    tick_->Reset();
    Posed X_WH = tick_->GraspFrame();
    const Vector3d way = random->Between(0, 3) * kPeriod * random->Vector(3).normalized();
    for (int k = 0; k < 60; ++k) {
      X_WH.p += way;
      ASSERT_NE(Step(X_WH, true).status, TickStatus::kFailed);
    }
    for (int k = static_cast<int>(random->Between(200, 500)); k > 0; --k) {
      ASSERT_NE(Step(X_WH, false).status, TickStatus::kFailed);
    }
  }

  KinematicTree tree_ = BuildKinematicTree(Example(GetParam()));
  VectorXd q_ = ClosedStart(tree_);
  CoupledTickOptions options_;
  std::unique_ptr<CoupledTick> tick_;
  std::vector<double> channels_;
};

/// The hand closes somewhere about the handle and stays where it is.
TEST_P(EveryGrab, GrowsNoFasterThanItsRateHoweverFastTheLink) {
  Random random(3);
  double fastest = 0;
  for (int grab = 0; grab < 30; ++grab) {
    Throw(&random);
    Posed X_WH = tick_->GraspFrame();
    X_WH.p += random.Vector(3, 0.05);
    ASSERT_TRUE(tick_->GraspAt(X_WH));
    fastest = std::max(fastest, tick_->dynamics().V_WG().head<3>().norm());
    Vector3d last = Vector3d::Zero();
    for (int k = 0; k < 120; ++k) {
      const TickOutput out = Step(X_WH, true);
      ASSERT_NE(out.status, TickStatus::kFailed);
      const Vector3d force = out.F_Ho_W.head<3>();
      // Friction ends with the motion: a light link that stops does so within a tick or two.
      constexpr double kStop = 20;  // [N]
      // What the hand can hold, and what the damper makes of a change of the link's speed that
      // could not be foreseen.
      constexpr double kSudden = 0.25;  // [m/s] in a tick
      const double unforeseen = std::min(kStop, kSudden * options_.coupling.damping[0]);
      ASSERT_LT(force.norm(), options_.grasp_rate * kPeriod * k + unforeseen) << grab << ' ' << k;
      ASSERT_LT((force - last).norm(), kStop) << grab << ' ' << k;
      last = force;
    }
  }
  EXPECT_GT(fastest, 1);  // [m/s]
}

INSTANTIATE_TEST_SUITE_P(Examples, EveryGrab,
                         testing::Values("crank", "two-link-arm", "slider-crank", "four-bar",
                                         "rssr", "bennett", "stewart-gough"),
                         [](const auto& info) { return TestName(info.param); });

}  // namespace
}  // namespace vmech::grab_test
