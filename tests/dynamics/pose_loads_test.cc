// The sanitizers bring an allocator of theirs.
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)

#include "vmech/dynamics/loads/pose/pose_loads.h"

#include <gtest/gtest.h>

#include "driven_examples.h"
#include "support/count_allocations.h"
#include "vmech/dynamics/loads/load_result.h"
#include "vmech/dynamics/loads/pose/store_pose_loads.h"
#include "vmech/dynamics/loads/prepare_study.h"
#include "vmech/dynamics/loads/track_motion.h"

namespace vmech {
namespace {

class EveryPose : public testing::TestWithParam<DrivenExample> {};

TEST_P(EveryPose, IsEvaluatedWithoutAllocation) {
  const LoadStudy study = StudyOf(GetParam().name);
  const PreparedStudy prepared = PrepareStudy(study);
  const Motion motion = TrackMotion(study, prepared, 1e-13);
  LoadWorkspace<double> ws(prepared.model);
  LoadArrays loads = MakeLoadArrays(prepared.model, motion, true);
  ASSERT_TRUE(EvaluatePoseLoads(prepared.model, motion, 0, &ws));
  const long before = allocations;
  for (size_t i = 0; i < motion.size(); ++i) {
    ASSERT_TRUE(EvaluatePoseLoads(prepared.model, motion, i, &ws));
    StorePoseLoads(prepared.model, motion, i, ws, &loads);
  }
  EXPECT_EQ(allocations - before, 0);
}

/// The acceleration of idle freedoms comes from small dense systems, which do allocate.
std::vector<DrivenExample> ExamplesWithoutIdleFreedoms() {
  std::vector<DrivenExample> examples = DrivenExamples();
  std::erase_if(examples, [](const DrivenExample& e) { return std::string(e.name) == "rssr"; });
  return examples;
}

INSTANTIATE_TEST_SUITE_P(Examples, EveryPose, testing::ValuesIn(ExamplesWithoutIdleFreedoms()),
                         [](const auto& info) { return TestName(info.param.name); });

}  // namespace
}  // namespace vmech
#endif
