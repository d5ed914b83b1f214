#include <gtest/gtest.h>

#include "reference_case.h"

#include "vmech/dynamics/loads/load_result.h"
#include "vmech/dynamics/loads/run_load_study.h"

namespace vmech::reference::bricard_test {
namespace {

/// Bricard's linkage of six revolutes, benchmark A04 of the IFToMM library of multibody problems:
/// let go at rest. Positions of P3 by absolute coordinates with multipliers, energy kept to 6e-14.
struct Row {
  double t;
  Vector3d p3;
};
const Row kRows[] = {
    {0.5, {0.9682836791067782, -1.2246251594363324, 0.7501466094377688}},
    {1.0, {0.5105014611872213, -1.649167599394806, 0.1401231145531867}},
};
constexpr double kStep = 0.005;      // [s] of the fourth-order rule of Runge and Kutta
constexpr double kTolerance = 1e-8;  // [m] that this step leaves

Vector3d PositionOfP3(const Mechanism& bricard, const PoseLoads& loads) {
  const Grasp& p3 = bricard.grasps[FindGrasp(bricard, "p3")];
  return loads.links[p3.link].X_WL * p3.X_LG.p;
}

/// Coordinate and rate of the first joint after one step of its free motion.
MotionSample Fall(const LoadStudy& study, const MotionSample& from, double step) {
  const auto rates = [&](double position, double velocity) {
    return Eigen::Vector2d(velocity, FreeAcceleration(study, "p0", position, velocity));
  };
  const Eigen::Vector2d y(from.position, from.velocity);
  const auto at = [&](const Eigen::Vector2d& k, double h) {
    const Eigen::Vector2d moved = y + h * k;
    return rates(moved[0], moved[1]);
  };
  const Eigen::Vector2d k1 = rates(y[0], y[1]);
  const Eigen::Vector2d k2 = at(k1, step / 2), k3 = at(k2, step / 2), k4 = at(k3, step);
  const Eigen::Vector2d end = y + step / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
  return {end[0], end[1], 0};
}

TEST(Bricard, HasOneFreedomAndOneRedundantEquation) {
  const LoadStudyResult result = RunLoadStudy(StudyAt(Example("bricard"), {{"p0", {0, 0, 0}}}));
  EXPECT_EQ(result.mobility, 1);
  EXPECT_EQ(result.redundant_equations, 1);
}

TEST(Bricard, FallsAsInTheBenchmark) {
  LoadStudy study = StudyAt(Example("bricard"), {{"p0", {0, 0, 0}}});
  MotionSample state;
  double t = 0;
  for (const Row& row : kRows) {
    for (; t < row.t - kStep / 2; t += kStep) {
      state = Fall(study, state, kStep);
      study.mechanism = LedTo(study.mechanism, "p0", state.position);
    }
    const PoseLoads loads = LoadsAt(study.mechanism, {{"p0", state}});
    EXPECT_LT((PositionOfP3(study.mechanism, loads) - row.p3).norm(), kTolerance) << row.t << " s";
  }
}

}  // namespace
}  // namespace vmech::reference::bricard_test
