// A component is certain only if no rule, stiffness, length or weight that the user may choose
// changes it; one that is called not determined does change.

#include <gtest/gtest.h>

#include <cmath>
#include <ostream>

#include "driven_examples.h"

#include "vmech/dynamics/loads/load_result.h"
#include "vmech/dynamics/loads/run_load_study.h"

namespace vmech {
namespace {

constexpr double kPromise = 1e-9;         // of the largest load
constexpr double kSame = 1e-10;           // beyond, a component may be called not determined
constexpr double kNearDeadCentre = 1e-5;  // where rounding is multiplied by the inverse

/// How a study is made ready to be asked.
enum class Setting { kPlain, kFriction, kHand };

struct Asked {
  std::string example;
  Setting setting;
};
void PrintTo(const Asked& asked, std::ostream* out) {
  constexpr const char* kWords[] = {"", "WithFriction", "InAHand"};
  *out << TestName(asked.example) << kWords[static_cast<int>(asked.setting)];
}

/// A few poses; gravity and load aslant, so that no component is zero for symmetry alone.
LoadStudy Prepared(const Asked& asked) {
  LoadStudy study = StudyOf(asked.example);
  study.mechanism.gravity_W += Vector3d(1.3, 2.1, -1.7);
  if (asked.setting == Setting::kFriction) {
    for (Joint& joint : study.mechanism.joints) {
      if (joint.type == JointType::kWeld) continue;
      joint.load_friction.coefficient = 0.05;
      joint.load_friction.radius = 0.02 * CharacteristicLength(study.mechanism);
    }
  }
  if (asked.setting == Setting::kHand) {
    const LoadStudyResult driven = RunLoadStudy(study);
    const Grasp& grasp = study.mechanism.grasps.at(0);
    constexpr size_t kRows = 17;  // less than half a turn
    std::vector<Posed> poses;
    for (size_t i = 0; i < kRows; ++i) {
      poses.push_back(driven.poses[i].links[grasp.link].X_WL * grasp.X_LG);
    }
    study.times.resize(kRows);
    study.hand = HandDrive{0, HandLaw::Table(study.times, poses)};
    study.drives.clear();
    return study;  // a hand that leaps may find another branch
  }
  study.times = {study.times[2], study.times[9], study.times[16]};
  return study;
}

LoadStudy WithRandomChoices(LoadStudy study, Random* random) {
  const auto factor = [&] { return std::pow(10, random->Between(-1.5, 1.5)); };
  study.rule = random->Between(0, 1) < 0.5 ? ReactionRule::kStiffness : ReactionRule::kMinimumNorm;
  study.norm_length = CharacteristicLength(study.mechanism) * factor();
  for (Joint& joint : study.mechanism.joints) {
    joint.stiffness = Vector6d::Constant(1e8);
    for (double& value : *joint.stiffness) value *= factor();
  }
  if (study.hand) {
    for (double& weight : study.hand->stiffness) weight = factor();
  }
  return study;
}

class EveryExampleIsAsked : public testing::TestWithParam<Asked> {};

/// The largest change of every component in any of some random choices, over the largest load.
std::vector<Vector6d> LargestChanges(const LoadStudy& study, const LoadStudyResult& result) {
  std::vector<Vector6d> changes(result.certainty.size(), Vector6d::Zero());
  Random random(5);
  for (int i = 0; i < 6; ++i) {
    const LoadStudyResult other = RunLoadStudy(WithRandomChoices(study, &random));
    for (size_t p = 0; p < result.poses.size(); ++p) {
      if (result.poses[p].smallest_pivot < kNearDeadCentre) continue;
      const LoadScale scale = ScaleOf(study.mechanism, result.poses[p]);
      for (size_t j = 0; j < changes.size(); ++j) {
        Vector6d change = (other.poses[p].joints[j] - result.poses[p].joints[j]).Stacked();
        change.head<3>() /= scale.force;
        change.tail<3>() /= scale.moment;
        changes[j] = changes[j].cwiseMax(change.cwiseAbs());
      }
    }
  }
  return changes;
}

TEST_P(EveryExampleIsAsked, CertainComponentsDependOnNoChoiceAndOthersDo) {
  const LoadStudy study = Prepared(GetParam());
  const LoadStudyResult result = RunLoadStudy(study);
  const std::vector<Vector6d> changes = LargestChanges(study, result);
  for (size_t j = 0; j < changes.size(); ++j) {
    for (int k = 0; k < 6; ++k) {
      const Certainty verdict = result.certainty[j][k];
      if (verdict == Certainty::kCertain) {
        EXPECT_LE(changes[j][k], kPromise) << study.mechanism.joints[j].name << "[" << k << "]";
      } else if (verdict == Certainty::kNotDetermined) {
        EXPECT_GT(changes[j][k], kSame) << study.mechanism.joints[j].name << "[" << k << "]";
      }
    }
  }
}

std::vector<Asked> AllAsked() {
  std::vector<Asked> asked;
  for (const DrivenExample& example : DrivenExamples()) {
    asked.push_back({example.name, Setting::kPlain});
    asked.push_back({example.name, Setting::kFriction});
    const bool has_grasp = !Example(example.name).grasps.empty();
    // Its path leads through the stretched arm, where a hand cannot tell the elbow's side.
    const bool told = std::string(example.name) != "two-link-arm";
    if (has_grasp && told) asked.push_back({example.name, Setting::kHand});
  }
  return asked;
}
INSTANTIATE_TEST_SUITE_P(, EveryExampleIsAsked, testing::ValuesIn(AllAsked()),
                         testing::PrintToStringParamName());

}  // namespace
}  // namespace vmech
