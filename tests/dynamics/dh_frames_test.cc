#include <gtest/gtest.h>

#include "driven_examples.h"
#include "vmech/dynamics/loads/load_result.h"
#include "vmech/dynamics/loads/run_load_study.h"
#include "vmech/mechanisms/dh/denavit_hartenberg.h"

namespace vmech {
namespace {

constexpr double kSameLoads = 1e-9;  // of the largest load: two assemblies of the same motion

class LoadsInDhFrames : public testing::TestWithParam<DrivenExample> {};

TEST_P(LoadsInDhFrames, AreThoseInTheFramesOfTheDrawing) {
  LoadStudy study = StudyOf(GetParam().name);
  const LoadStudyResult drawn = RunLoadStudy(study);
  const Mechanism original = study.mechanism;
  const DhTable table = DeduceDhTable(original, FindSpanningTree(original));
  study.mechanism = DrawnInLinkFrames(original, table);
  ExternalLoad& load = study.external[0];
  load.p_L = table.link_frames[load.link].inverse() * load.p_L;
  EXPECT_LT(RelativeDifference(original, drawn, RunLoadStudy(study)), kSameLoads);
}

INSTANTIATE_TEST_SUITE_P(All, LoadsInDhFrames, testing::ValuesIn(DrivenExamples()),
                         [](const auto& info) { return TestName(info.param.name); });

}  // namespace
}  // namespace vmech
