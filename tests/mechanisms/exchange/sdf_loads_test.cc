// A mechanism that has been through SDF carries the same loads.

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>

#include "driven_examples.h"
#include "support/temp_folder.h"
#include "vmech/dynamics/loads/load_result.h"
#include "vmech/dynamics/loads/run_load_study.h"
#include "vmech/mechanisms/exchange/sdf/sdf.h"
#include "vmech/mechanisms/freedoms.h"

namespace vmech::sdf_loads_test {
namespace {

constexpr double kSameLoads = 1e-9;  // of the largest load: poses written with 16 digits

Mechanism ThroughSdf(const Mechanism& mechanism) {
  const TempFolder folder;
  std::ofstream(folder / "there.sdf") << WriteSdf(mechanism).text;
  return ReadSdf(folder / "there.sdf").mechanism;
}

/// What SDF cannot say: it must not differ.
Mechanism WithoutJointStiffnessAndLoadFriction(Mechanism mechanism) {
  for (Joint& joint : mechanism.joints) {
    joint.stiffness.reset();
    joint.load_friction = {};
  }
  return mechanism;
}

/// The joint that has become of one: itself, or the last of the chain that it became.
int JointAfter(const Mechanism& after, const std::string& name) {
  for (const char* suffix : {"", "_joint", "_rz", "_z"}) {
    if (const int joint = FindJoint(after, name + suffix); joint >= 0) return joint;
  }
  return -1;
}

/// The freedom that has become of one.
int FreedomAfter(const Mechanism& after, const Joint& joint, int freedom, int* in_joint) {
  const int chained = FindJoint(after, joint.name + "_" + NameOfFreedom(joint.type, freedom));
  *in_joint = FreedomsOf(joint.type) > 1 && chained >= 0 ? chained : JointAfter(after, joint.name);
  return chained >= 0 ? 0 : freedom;
}

LoadStudy StudyAfter(LoadStudy study, const Mechanism& after) {
  for (JointDrive& drive : study.drives) {
    const Joint& joint = study.mechanism.joints[drive.joint];
    const MotionSample at_start = drive.law.At(0), later = drive.law.At(1);
    drive.freedom = FreedomAfter(after, joint, drive.freedom, &drive.joint);
    // From zero on instead of from the start of the original.
    drive.law = MotionLaw::Uniform(0, at_start.velocity, later.acceleration);
  }
  study.mechanism = after;
  return study;
}

/// What a joint's first link exerts on the second, in world axes.
Wrenchd InWorld(const Mechanism& mechanism, const PoseLoads& pose, int joint) {
  const AnchorId first = mechanism.joints[joint].first;
  const Matrix3d R_WF = pose.links[first.link].X_WL.R * mechanism.anchor(first).X_LA.R;
  const Wrenchd& W = pose.joints[joint];
  return {R_WF * W.force, R_WF * W.moment};
}

class LoadsThroughSdf : public testing::TestWithParam<DrivenExample> {};

TEST_P(LoadsThroughSdf, AreTheSame) {
  if (!HasSdfReader()) GTEST_SKIP() << "vmech was built without libsdformat";
  LoadStudy study =
      StudyOf(WithoutJointStiffnessAndLoadFriction(Example(GetParam().name)), GetParam());
  // Not that of the anchors: one that several joints share comes back as several.
  study.norm_length = CharacteristicLength(study.mechanism);
  const Mechanism after = ThroughSdf(study.mechanism);
  const LoadStudyResult before = RunLoadStudy(study), then = RunLoadStudy(StudyAfter(study, after));
  ASSERT_EQ(before.poses.size(), then.poses.size());
  for (size_t i = 0; i < before.poses.size(); ++i) {
    const LoadScale scale = ScaleOf(study.mechanism, before.poses[i]);
    for (int j = 0; j < static_cast<int>(study.mechanism.joints.size()); ++j) {
      const std::string& name = study.mechanism.joints[j].name;
      const Wrenchd difference = InWorld(study.mechanism, before.poses[i], j) -
                                 InWorld(after, then.poses[i], JointAfter(after, name));
      EXPECT_LT(difference.force.norm(), kSameLoads * scale.force) << name << ", pose " << i;
      EXPECT_LT(difference.moment.norm(), kSameLoads * scale.moment) << name << ", pose " << i;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(All, LoadsThroughSdf, testing::ValuesIn(DrivenExamples()),
                         [](const auto& info) { return TestName(info.param.name); });

}  // namespace
}  // namespace vmech::sdf_loads_test
