#include "vmech/dynamics/loads/load_arrays.h"
#include "vmech/base/lanes4.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <numeric>
#include <utility>

#include "driven_examples.h"
#include "vmech/dynamics/loads/run_load_study.h"

namespace vmech {
namespace {

LoadArrays::Shape SmallShape() {
  return {.poses = 2, .drives = 1, .freedoms = {1, 0, 3}, .links = 2};
}

TEST(LoadArrays, HaveARowForEachPose) {
  const LoadArrays loads(SmallShape());
  EXPECT_EQ(loads.wrenches.size(), 2u * 3 * 6);
  EXPECT_EQ(loads.positions.size(), 2u * 4);
  EXPECT_EQ(loads.rates.size(), 2u * 4);
  EXPECT_EQ(loads.links.size(), 2u * 2);
  EXPECT_TRUE(loads.hands.empty());
  EXPECT_TRUE(loads.states.empty());
}

TEST(LoadArrays, LieInOnePieceAndMoveWithIt) {
  constexpr size_t kPoses = 1 << 16;
  LoadArrays made({.poses = kPoses, .drives = 1, .freedoms = {1, 2}, .links = 3});
  made.powers.back() = 7;
  const auto begin = [](const auto& array) { return reinterpret_cast<const char*>(array.data()); };
  const auto bytes = [](const auto&... arrays) {
    return (0 + ... + (arrays.size() * sizeof(arrays[0])));
  };
  const LoadArrays& a = made;
  const size_t all =
      bytes(a.times, a.drives, a.drive_forces, a.wrenches, a.positions, a.rates, a.accelerations,
            a.powers, a.power_errors, a.power_error_scales, a.smallest_pivots, a.closures, a.links);
  for (const char* array :
       {begin(a.drives), begin(a.wrenches), begin(a.closures), begin(a.links)}) {
    EXPECT_LT(static_cast<size_t>(std::abs(array - begin(a.times))), all);
  }
  const double* const powers = a.powers.data();
  const LoadArrays moved(std::move(made));
  EXPECT_EQ(moved.powers.data(), powers);
  EXPECT_EQ(moved.powers.back(), 7);
}

TEST(LoadArrays, AJointIsItsPartOfEveryArray) {
  LoadArrays loads(SmallShape());
  for (LoadArrays::Array* array :
       {&loads.wrenches, &loads.positions, &loads.rates, &loads.accelerations}) {
    std::iota(array->begin(), array->end(), 100.0 * array->size());
  }
  const JointSample last = loads.Joint(1, 2);
  EXPECT_EQ(last.force, Vector3d(3630, 3631, 3632));
  EXPECT_EQ(last.moment, Vector3d(3633, 3634, 3635));
  EXPECT_EQ(last.position, Vector3d(805, 806, 807));
  EXPECT_EQ(last.rate, Vector3d(805, 806, 807));
  EXPECT_EQ(last.acceleration, Vector3d(805, 806, 807));
  EXPECT_EQ(loads.Joint(1, 0).position, Vector3d(804, 0, 0));
  EXPECT_EQ(loads.Joint(1, 1).rate, Vector3d(0, 0, 0));
}

TEST(PoseLoads, OutlivesTheResultItIsTakenFrom) {
  PoseLoads pose;
  {
    LoadStudyResult result = RunLoadStudy(StudyOf("slider-crank"));
    pose = result.poses[3];
    result = LoadStudyResult();
  }
  const LoadStudyResult again = RunLoadStudy(StudyOf("slider-crank"));
  ASSERT_EQ(pose.joints.size(), again.poses[3].joints.size());
  for (size_t j = 0; j < pose.joints.size(); ++j) {
    EXPECT_EQ(pose.joints[j].Stacked(), again.poses[3].joints[j].Stacked());
  }
  EXPECT_EQ(pose.links[1].X_WL.p, again.poses[3].links[1].X_WL.p);
}

TEST(StoreLanes, GivesEachLaneItsRow) {
  constexpr int kMost = 9, kStride = 11;
  std::vector<Lanes4> values;
  for (int k = 0; k < kMost; ++k) {
    values.push_back(FromLanes<Lanes4>([&](int lane) { return 10.0 * k + lane; }));
  }
  for (int count = 0; count <= kMost; ++count) {
    std::vector<double> rows(4 * kStride, -1);
    StoreLanes(values.data(), count, rows.data(), kStride);
    for (int lane = 0; lane < 4; ++lane) {
      for (int k = 0; k < kStride; ++k) {
        EXPECT_EQ(rows[lane * kStride + k], k < count ? 10 * k + lane : -1);
      }
    }
  }
}

}  // namespace
}  // namespace vmech
