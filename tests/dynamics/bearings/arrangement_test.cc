#include "vmech/dynamics/bearings/arrangement.h"

#include <gtest/gtest.h>

#include <random>
#include <stdexcept>

namespace vmech {
namespace {

/// A few operations on numbers up to 1e3.
constexpr double kRoundoff = 1e-10;

std::vector<Wrenchd> RandomWrenches(int count) {
  std::mt19937 generator(7);
  std::uniform_real_distribution<double> uniform(-1000, 1000);
  std::vector<Wrenchd> wrenches(count);
  for (Wrenchd& w : wrenches) {
    for (int i = 0; i < 3; ++i) {
      w.force[i] = uniform(generator);
      w.moment[i] = uniform(generator) / 20;
    }
  }
  return wrenches;
}

TEST(DistributeLoads, HoldsTheJointInEquilibrium) {
  const std::vector<Wrenchd> wrenches = RandomWrenches(50);
  for (int locating : {0, 1}) {
    const Arrangement arrangement{{-0.015, 0.04}, locating};
    const ArrangementLoads loads = DistributeLoads(arrangement, wrenches);
    for (size_t i = 0; i < wrenches.size(); ++i) {
      Vector3d force = Vector3d::Zero(), moment = Vector3d::Zero();
      for (int k = 0; k < 2; ++k) {
        const Vector3d& R = loads.forces[k][i].force;
        force += R;
        moment += Vector3d(0, 0, arrangement.positions[k]).cross(R);
      }
      EXPECT_LT((force - wrenches[i].force).norm(), kRoundoff);
      EXPECT_LT((moment - wrenches[i].moment).head(2).norm(), kRoundoff);
      EXPECT_EQ(loads.forces[1 - locating][i].axial(), 0);
      EXPECT_EQ(loads.tilting_moment[i], 0);
    }
  }
}

TEST(DistributeLoads, TurnsATiltingMomentIntoACouple) {
  const std::vector<Wrenchd> wrenches{{{0, 0, 0}, {6, 0, 0}}};
  const ArrangementLoads loads = DistributeLoads({{-0.01, 0.02}, 0}, wrenches);
  EXPECT_NEAR(loads.forces[0][0].force.y(), 200, kRoundoff);
  EXPECT_NEAR(loads.forces[1][0].force.y(), -200, kRoundoff);
}

TEST(DistributeLoads, SharesAForceByTheLever) {
  const std::vector<Wrenchd> wrenches{{{900, 0, 50}, {0, 0, 0}}};
  const ArrangementLoads loads = DistributeLoads({{-0.01, 0.02}, 1}, wrenches);
  EXPECT_NEAR(loads.forces[0][0].radial(), 600, kRoundoff);
  EXPECT_NEAR(loads.forces[1][0].radial(), 300, kRoundoff);
  EXPECT_NEAR(loads.forces[1][0].axial(), 50, kRoundoff);
}

TEST(DistributeLoads, DoesNotDependOnTheOrderOfTheBearings) {
  const std::vector<Wrenchd> wrenches = RandomWrenches(5);
  const ArrangementLoads there = DistributeLoads({{-0.015, 0.04}, 0}, wrenches);
  const ArrangementLoads back = DistributeLoads({{0.04, -0.015}, 1}, wrenches);
  for (size_t i = 0; i < wrenches.size(); ++i) {
    EXPECT_LT((there.forces[0][i].force - back.forces[1][i].force).norm(), kRoundoff);
    EXPECT_LT((there.forces[1][i].force - back.forces[0][i].force).norm(), kRoundoff);
  }
}

TEST(DistributeLoads, ReportsTheMomentASingleBearingCannotTake) {
  // 100 N across the axis, 30 mm beside the bearing at 10 mm: 100 N at 40 mm from the origin.
  const std::vector<Wrenchd> wrenches{{{100, 0, 7}, {0, 4, 0}}, {{100, 0, 7}, {0, 1, 0}}};
  const ArrangementLoads loads = DistributeLoads({{0.01}, 0}, wrenches);
  EXPECT_NEAR(loads.tilting_moment[0], 3, kRoundoff);
  EXPECT_NEAR(loads.tilting_moment[1], 0, kRoundoff);
  EXPECT_EQ(loads.forces[0][0].radial(), 100);
  EXPECT_EQ(loads.forces[0][0].axial(), 7);
}

TEST(Arrangement, RefusesWhatCannotBeBuilt) {
  EXPECT_THROW((Arrangement{{}, 0}.Validate()), std::invalid_argument);
  EXPECT_THROW((Arrangement{{0, 1, 2}, 0}.Validate()), std::invalid_argument);
  EXPECT_THROW((Arrangement{{0.01, 0.01}, 0}.Validate()), std::invalid_argument);
  EXPECT_THROW((Arrangement{{0.0}, 1}.Validate()), std::invalid_argument);
  EXPECT_THROW((Arrangement{{0.0, 0.1}, -1}.Validate()), std::invalid_argument);
  EXPECT_NO_THROW(Arrangement{}.Validate());
}

}  // namespace
}  // namespace vmech
