#include "vmech/apps/compare/suite_reader.h"

#include <gtest/gtest.h>

#include <stdexcept>

#include "support/examples.h"
#include "vmech/mechanisms/files/document.h"

namespace vmech {
namespace {

const std::string kSuite = R"(vmech_suite: "1.0"
description: trial
units: {length: mm}
seed: 5
repetitions: 2
stopping: {constraint_tolerance: 1e-9, optimality_tolerance: 1e-7, max_iterations: 40}
reach_tolerance: 1e-5
targets:
  near: {kind: reachable, count: 7, start: near, start_distance: 0.3}
  off:  {kind: unreachable, count: 3, start: far, offset: 0.2}
  path: {kind: tracking, count: 2, steps: 30, step: 0.01}
mechanisms:
  by-rod:    {file: slider-crank.yaml, grasp: handle}
  by-slider: {file: slider-crank.yaml, grasp: {link: slider, origin: [10, 0, 0], kind: point},
              targets: [path, near]}
)";

std::string Replaced(std::string text, const std::string& passage, const std::string& replacement) {
  const size_t at = text.find(passage);
  if (at == text.npos) throw std::logic_error("the passage is not in the text: " + passage);
  return text.replace(at, passage.size(), replacement);
}

Suite Parse(const std::string& text) {
  return ParseSuite(text, std::string(VMECH_EXAMPLES) + "/suite.yaml");
}

/// What is said of a suite in which a passage is replaced, without the folder.
std::string Refusal(const std::string& passage, const std::string& replacement) {
  try {
    Parse(Replaced(kSuite, passage, replacement));
  } catch (const FileErrors& errors) {
    std::string what = errors.what();
    const std::string folder = std::string(VMECH_EXAMPLES) + "/";
    for (size_t at; (at = what.find(folder)) != what.npos;) what.erase(at, folder.size());
    return what;
  }
  return "";
}

TEST(SuiteReader, ReadsWhatTheWholeSuiteHasInCommon) {
  const Suite suite = Parse(kSuite);
  EXPECT_EQ(suite.name, "suite");
  EXPECT_EQ(suite.description, "trial");
  EXPECT_EQ(suite.seed, 5u);
  EXPECT_EQ(suite.repetitions, 2);
  EXPECT_EQ(suite.stopping.constraint_tolerance, 1e-9);
  EXPECT_EQ(suite.stopping.optimality_tolerance, 1e-7);
  EXPECT_EQ(suite.stopping.max_iterations, 40);
  EXPECT_EQ(suite.reach_tolerance, 1e-5);
}

TEST(SuiteReader, ReadsBlocksOfTargets) {
  const std::vector<TargetBlock> blocks = Parse(kSuite).blocks;
  ASSERT_EQ(blocks.size(), 3u);
  EXPECT_EQ(blocks[0].kind, TargetKind::kReachable);
  EXPECT_EQ(blocks[0].start_distance, 0.3);
  EXPECT_EQ(blocks[1].kind, TargetKind::kUnreachable);
  EXPECT_EQ(blocks[1].start, StartKind::kFar);
  EXPECT_EQ(blocks[1].offset, 0.2);
  EXPECT_EQ(blocks[2].kind, TargetKind::kTracking);
  EXPECT_EQ(blocks[2].steps, 30);
  EXPECT_EQ(blocks[2].step, 0.01);
}

TEST(SuiteReader, ReadsMechanismsWithTheirGraspsAndBlocks) {
  const Suite suite = Parse(kSuite);
  ASSERT_EQ(suite.mechanisms.size(), 2u);
  EXPECT_EQ(suite.mechanisms[0].grasp.name, "handle");
  EXPECT_EQ(suite.mechanisms[0].blocks, (std::vector<int>{0, 1, 2}));
  const SuiteMechanism& by_slider = suite.mechanisms[1];
  EXPECT_EQ(by_slider.grasp.link, FindLink(by_slider.mechanism, "slider"));
  EXPECT_EQ(by_slider.grasp.X_LG.p.x(), 0.01);
  EXPECT_EQ(by_slider.grasp.kind, GraspKind::kPoint);
  EXPECT_EQ(by_slider.blocks, (std::vector<int>{0, 2}));
}

TEST(SuiteReader, CountsTheProblemsOfEveryMechanismsBlocks) {
  EXPECT_EQ(ProblemsOf(Parse(kSuite)).size(), 7u + 3u + 2u + 7u + 2u);
}

TEST(SuiteReader, GivesAnotherDigestForEveryChange) {
  EXPECT_EQ(Parse(kSuite).digest, Parse(kSuite).digest);
  EXPECT_NE(Parse(kSuite).digest, Parse(Replaced(kSuite, "seed: 5", "seed: 6")).digest);
  EXPECT_NE(Parse(kSuite).digest,
            Parse(Replaced(kSuite, "slider-crank.yaml", "marghitu-slider-crank.yaml")).digest);
}

TEST(SuiteReader, RefusesWhatIsMalformedWithPlaceAndRemedy) {
  const struct {
    const char *passage, *replacement, *refusal;
  } cases[] = {
      {"vmech_suite: \"1.0\"", "vmech_suite: \"2.0\"",
       "suite.yaml:1:14: vmech_suite: this is format '2.0'; only 1.0 can be read"},
      {"kind: reachable", "kind: reachible",
       "suite.yaml:9:16: targets.near.kind: 'reachible' is not one of: reachable, unreachable, "
       "singular, dead_centre, tracking; did you mean 'reachable'?"},
      {"count: 7", "count: 0",
       "suite.yaml:9:34: targets.near.count: must be a whole number from 1 to 1000000, not 0"},
      {"kind: tracking, count: 2", "kind: tracking",
       "suite.yaml:11:3: targets.path: the key 'count' is missing"},
      {"steps: 30", "start: near",
       "suite.yaml:11:36: targets.path.start: targets of kind 'tracking' have no 'start'"},
      {"offset: 0.2", "closeness: 0.2",
       "suite.yaml:10:51: targets.off.closeness: targets of kind 'unreachable' have no "
       "'closeness'"},
      {"offset: 0.2", "start_distance: 0.2",
       "suite.yaml:10:51: targets.off.start_distance: used with 'start: near' only"},
      {"grasp: handle", "grasp: handel",
       "suite.yaml:13:47: mechanisms.by-rod.grasp: grasp 'handel' not found; did you mean "
       "'handle'?"},
      {"link: slider", "link: slidder",
       "suite.yaml:14:54: mechanisms.by-slider.grasp.link: link 'slidder' not found; did you mean "
       "'slider'?"},
      {"link: slider", "link: frame",
       "suite.yaml:14:54: mechanisms.by-slider.grasp.link: the ground does not move"},
      {"[path, near]", "[path, neer]",
       "suite.yaml:15:31: mechanisms.by-slider.targets[1]: block of targets 'neer' not found; did "
       "you mean 'near'?"},
      {"[path, near]", "[path, path]",
       "suite.yaml:15:31: mechanisms.by-slider.targets[1]: this block is already named"},
      {"max_iterations: 40", "max_iteration: 40",
       "suite.yaml:6:68: stopping.max_iteration: unknown key 'max_iteration'; did you mean "
       "'max_iterations'?"},
      {"optimality_tolerance: 1e-7", "optimality_tolerance: -1",
       "suite.yaml:6:62: stopping.optimality_tolerance: must be greater than zero, not -1"},
      {"count: 7", "count: -7",
       "suite.yaml:9:34: targets.near.count: must be a whole number from 1 to 1000000, not -7"},
      {"count: 7", "count: .nan",
       "suite.yaml:9:34: targets.near.count: expected a finite number, not '.nan'"},
      {"count: 7", "count: 600000",
       "suite.yaml:8:1: targets: 1200007 problems (the sum of the counts over all mechanisms) are "
       "more than 1000000; lower them, or make several suites"},
      {"count: 2, steps: 30", "count: 20000, steps: 30000",
       "suite.yaml:8:1: targets: 1200000000 targets on paths (the sum of the counts times steps) "
       "are more than 1000000000; lower them, or make several suites"},
      {"repetitions: 2", "repetitions: 0",
       "suite.yaml:5:14: repetitions: must be a whole number from 1 to 1000, not 0"},
      {"start_distance: 0.3", "start_distance: 1e9",
       "suite.yaml:9:66: targets.near.start_distance: must be from 1e-09 to 10, but is 1e+09"},
      {"offset: 0.2", "offset: -0.2",
       "suite.yaml:10:59: targets.off.offset: must be from 1e-09 to 100, but is -0.2"},
      {"step: 0.01", "step: 1e-12",
       "suite.yaml:11:53: targets.path.step: must be from 1e-06 to 1, but is 1e-12"},
      {"steps: 30", "steps: 1",
       "suite.yaml:11:43: targets.path.steps: must be a whole number from 2 to 100000, not 1"},
      {"reach_tolerance: 1e-5", "reach_tolerance: 0",
       "suite.yaml:7:18: reach_tolerance: must be from 1e-15 to 1, but is 0"},
      {"constraint_tolerance: 1e-9", "constraint_tolerance: 2",
       "suite.yaml:6:11: stopping: StoppingRule.constraint_tolerance = 2, must be in "
       "[2.2250738585072014e-308, 1]"},
      {"file: slider-crank.yaml, grasp: handle", "file: slider-crnk.yaml, grasp: handle",
       "slider-crnk.yaml: cannot be opened as a file"},
  };
  for (const auto& c : cases) EXPECT_EQ(Refusal(c.passage, c.replacement), c.refusal);
}

}  // namespace
}  // namespace vmech
