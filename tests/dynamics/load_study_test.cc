#include "vmech/dynamics/loads/load_study.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "driven_examples.h"
#include "vmech/base/lanes4.h"
#include "vmech/dynamics/loads/load_result.h"
#include "vmech/dynamics/loads/pose/pose_loads.h"
#include "vmech/dynamics/loads/pose/store_pose_loads.h"
#include "vmech/dynamics/loads/prepare_study.h"
#include "vmech/dynamics/loads/run_load_study.h"
#include "vmech/dynamics/loads/track_motion.h"
#include "vmech/mechanisms/files/reader.h"

namespace vmech {
namespace {

using testing::AllOf;
using testing::HasSubstr;

bool SameBits(const Wrenchd& a, const Wrenchd& b) {
  return std::memcmp(a.force.data(), b.force.data(), sizeof(Vector3d)) == 0 &&
         std::memcmp(a.moment.data(), b.moment.data(), sizeof(Vector3d)) == 0;
}

/// More poses than one thread takes at a time.
LoadStudy LongStudy(const std::string& example) {
  LoadStudy study = StudyOf(example);
  study.times.clear();
  for (int i = 0; i < 300; ++i) study.times.push_back(0.5 * i / 299);
  return study;
}

/// Four poses at once are the four poses: every wrench, power and rate.
TEST(PacketOfPoses, IsEachPoseOfItsOwn) {
  constexpr double kRounding = 1e-12;  // of the largest load: the two round differently
  for (const DrivenExample& example : DrivenExamples()) {
    const LoadStudy study = StudyOf(example.name);
    const PreparedStudy prepared = PrepareStudy(study);
    if (!RunsInLanes(prepared.model)) continue;
    const Motion motion = TrackMotion(study, prepared, 1e-13);
    LoadWorkspace<double> ws(prepared.model);
    LoadWorkspace<Lanes4> packet_ws(prepared.model);
    ASSERT_TRUE(EvaluatePoseLoads(prepared.model, motion, 4, &packet_ws));
    const auto loads = std::make_shared<LoadArrays>(MakeLoadArrays(prepared.model, motion, true));
    const auto single = std::make_shared<LoadArrays>(MakeLoadArrays(prepared.model, motion, true));
    StorePoseLoads(prepared.model, motion, 4, packet_ws, loads.get());
    for (int lane = 0; lane < Lanes4::kLanes; ++lane) {
      ASSERT_TRUE(EvaluatePoseLoads(prepared.model, motion, 4 + lane, &ws));
      StorePoseLoads(prepared.model, motion, 4 + lane, ws, single.get());
      const PoseLoads alone(single, 4 + lane), together(loads, 4 + lane);
      EXPECT_LT(RelativeDifference(study.mechanism, alone, together), kRounding) << example.name;
      EXPECT_NEAR(alone.power, together.power, kRounding * (1 + std::abs(alone.power)));
      EXPECT_EQ(alone.time, together.time);
    }
  }
}

class Threads : public testing::TestWithParam<const char*> {};

TEST_P(Threads, GiveTheSameBitsHoweverManyTheyAre) {
  const LoadStudy study = LongStudy(GetParam());
  const LoadStudyResult alone = RunLoadStudy(study);
  for (const int threads : {2, 3}) {
    LoadStudyOptions options;
    options.threads = threads;
    const LoadStudyResult together = RunLoadStudy(study, options);
    ASSERT_EQ(together.poses.size(), alone.poses.size());
    for (size_t i = 0; i < alone.poses.size(); ++i) {
      for (size_t j = 0; j < alone.poses[i].joints.size(); ++j) {
        ASSERT_TRUE(SameBits(alone.poses[i].joints[j], together.poses[i].joints[j])) << i;
      }
      for (size_t k = 0; k < alone.poses[i].drives.size(); ++k) {
        ASSERT_EQ(alone.poses[i].drives[k].force, together.poses[i].drives[k].force) << i;
      }
    }
    EXPECT_EQ(alone.max_power_error, together.max_power_error);
  }
}

INSTANTIATE_TEST_SUITE_P(Examples, Threads,
                         testing::Values("slider-crank", "rssr", "delta-robot", "bennett"),
                         [](const auto& info) { return TestName(info.param); });

/// The message with which a study is refused.
std::string Refusal(const LoadStudy& study, const LoadStudyOptions& options = {}) {
  try {
    RunLoadStudy(study, options);
  } catch (const std::exception& error) {
    return error.what();
  }
  return "";
}

JointDrive DriveAt(const Mechanism& mechanism, const std::string& joint, double speed) {
  const int index = FindJoint(mechanism, joint);
  return {index, 0, MotionLaw::Uniform(mechanism.joints[index].start[0], speed)};
}

TEST(RefusedStudy, SaysThatItHasNoDrive) {
  LoadStudy study = StudyOf("slider-crank");
  study.drives.clear();
  EXPECT_THAT(Refusal(study), HasSubstr("nothing prescribes the freedom"));
}

TEST(RefusedStudy, SaysThatItHasNoPoses) {
  LoadStudy study = StudyOf("slider-crank");
  study.times.clear();
  EXPECT_THAT(Refusal(study), HasSubstr("no poses"));
}

TEST(RefusedStudy, NamesTheDrivesThatAreTooMany) {
  LoadStudy study = StudyOf("slider-crank");
  study.drives.push_back(DriveAt(study.mechanism, "guide", 0.1));
  EXPECT_THAT(Refusal(study), AllOf(HasSubstr("'main'"), HasSubstr("'guide'"),
                                    HasSubstr("mobility 1"), HasSubstr("drive fewer joints")));
}

TEST(RefusedStudy, NamesTheFreedomThatNothingDrives) {
  LoadStudy study = StudyOf("two-link-arm");
  study.drives.pop_back();
  EXPECT_THAT(Refusal(study), AllOf(HasSubstr("mobility 2"), HasSubstr("'elbow'")));
}

TEST(RefusedStudy, NamesAJointThatCannotBeDriven) {
  LoadStudy study = StudyOf("rssr");
  study.drives[0].joint = FindJoint(study.mechanism, "ball_a");
  EXPECT_THAT(Refusal(study), AllOf(HasSubstr("'ball_a'"), HasSubstr("spherical")));
  study.drives[0] = DriveAt(study.mechanism, "input", 1);
  study.drives[0].freedom = 1;
  EXPECT_THAT(Refusal(study), AllOf(HasSubstr("'input'"), HasSubstr("has 1 of them")));
}

TEST(RefusedStudy, NamesThePoseThatIsOutOfReach) {
  // The guide goes from 184.8 mm past the 200 mm at which crank and rod are in line.
  LoadStudy study = StudyOf("slider-crank");
  study.drives = {DriveAt(study.mechanism, "guide", 0.04)};
  study.times = {0, 0.2, 0.4, 0.6};
  EXPECT_THAT(Refusal(study),
              AllOf(HasSubstr("pose 2"), HasSubstr("t = 0.4"), HasSubstr("'guide'")));
}

TEST(RefusedStudy, SaysWhichOptionIsOutOfRange) {
  LoadStudyOptions options;
  options.threads = 0;
  EXPECT_THAT(Refusal(StudyOf("crank"), options), AllOf(HasSubstr("threads"), HasSubstr("0")));
}

TEST(RefusedStudy, StopsWhenItsProgressSaysSo) {
  LoadStudyOptions options;
  options.progress = [](size_t) { return false; };
  EXPECT_THAT(Refusal(LongStudy("slider-crank"), options), HasSubstr("stopped"));
  // Before the first pose has its loads, too: the motion of millions of poses takes its time.
  LoadStudy study = LongStudy("slider-crank");
  for (int i = 0; i < 5000; ++i) study.times.push_back(0.5 + 1e-6 * (i + 1));
  int asked = 0;
  options.progress = [&](size_t done) { return ++asked > 1 || done > 0; };
  EXPECT_THAT(Refusal(study, options), HasSubstr("stopped"));
  EXPECT_EQ(asked, 1);
}

TEST(DeadCentres, AreWarnedOfBesideThemToo) {
  LoadStudy study = StudyOf("square-four-bar");
  const auto warned = testing::Contains(HasSubstr("beside a dead centre, pose 1 by"));
  study.drives[0].law = MotionLaw::Uniform(M_PI / 2 - 0.4, 1);  // flat after 0.4 s
  study.times = {0, 0.39};
  EXPECT_THAT(RunLoadStudy(study).warnings, testing::Not(warned));
  study.times = {0, 0.4 - 3e-5};
  EXPECT_THAT(RunLoadStudy(study).warnings, warned);
}

TEST(IdleFreedoms, TheSpinOfTheRodOfAnRssrIsListed) {
  const LoadStudyResult result = RunLoadStudy(StudyOf("rssr"));
  EXPECT_EQ(result.mobility, 2);
  ASSERT_EQ(result.idle.size(), 1u);
  EXPECT_THAT(result.idle[0], HasSubstr("ball"));
}

// A bracket that is welded to the wall carries its weight; of two welds nobody knows which does.
TEST(Structure, IsHeldByItsWelds) {
  const std::string bracket = R"(vmech: "1.0"
gravity: [0, 0, -10]
ground: wall
links:
  wall: {anchors: {a: {origin: [0, 0, 0]}, b: {origin: [0, 1, 0]}}}
  bracket: {mass: 3, center_of_gravity: [0.5, 0, 0],
            anchors: {a: {origin: [0, 0, 0]}, b: {origin: [0, 1, 0]}}}
joints:
  a: {type: weld, connects: [wall/a, bracket/a]}
)";
  LoadStudy study;
  study.times = {0};
  for (const bool twice : {false, true}) {
    const std::string second = "  b: {type: weld, connects: [wall/b, bracket/b]}\n";
    study.mechanism = ParseMechanism(bracket + (twice ? second : ""), "bracket");
    const LoadStudyResult result = RunLoadStudy(study);
    Vector3d force = Vector3d::Zero();
    for (const JointSample& joint : result.poses[0].joints) force += joint.force;
    EXPECT_NEAR((force - Vector3d(0, 0, 30)).norm(), 0, 1e-9);
    EXPECT_EQ(result.certainty[0][2], twice ? Certainty::kNotDetermined : Certainty::kCertain);
  }
}

TEST(IdleFreedoms, WarnOfWhatWouldSetThemMoving) {
  LoadStudy study = StudyOf("rssr");
  const auto warned = testing::Contains(HasSubstr("act with up to"));
  EXPECT_THAT(RunLoadStudy(study).warnings, testing::Not(warned));
  for (Joint& joint : study.mechanism.joints) {
    if (joint.type != JointType::kSpherical) continue;
    for (Passive& passive : joint.passive) passive.viscous = 0.01;
  }
  EXPECT_THAT(RunLoadStudy(study).warnings, warned);
}

TEST(IdleFreedoms, DoNotChangeTheLoadsWhereverTheyStand) {
  // The rod's spin at the start is what the file says; turn it by a quarter of a turn.
  LoadStudy study = StudyOf("rssr");
  const LoadStudyResult expected = RunLoadStudy(study);
  Link& rod = study.mechanism.links[FindLink(study.mechanism, "rod")];
  Matrix3d quarter;
  quarter << 1, 0, 0, 0, 0, -1, 0, 1, 0;
  for (Anchor& anchor : rod.anchors) anchor.X_LA.R = quarter * anchor.X_LA.R;
  const LoadStudyResult turned = RunLoadStudy(study);
  // The rod is symmetric about its x axis. Forces alone: ball_b's axes turn with the rod.
  for (size_t i = 0; i < expected.poses.size(); ++i) {
    EXPECT_NEAR(expected.poses[i].drives[0].force, turned.poses[i].drives[0].force, 1e-9);
    for (size_t j = 0; j < expected.poses[i].joints.size(); ++j) {
      EXPECT_NEAR(expected.poses[i].joints[j].force.norm(), turned.poses[i].joints[j].force.norm(),
                  1e-9 * (1 + expected.poses[i].joints[j].force.norm()));
    }
  }
}

/// A crank that turns at 2 rad/s under a moment from a table.
class LoadTable : public testing::Test {
 protected:
  LoadTable() : study_(StudyOf("crank")) {
    study_.drives = {DriveAt(study_.mechanism, "main", 2)};
    study_.times = {0.25, 0.75, 1.25};
    study_.external[0].at = {0, 0.5, 1};
    study_.external[0].wrenches = {Moment(0), Moment(2), Moment(-4)};
    study_.external[0].over = ExternalLoad::Over::kTime;
  }
  static Wrenchd Moment(double z) { return {Vector3d::Zero(), Vector3d(0, 0, z)}; }

  /// What the drive exerts against the table at a pose.
  double Against(size_t pose) const {
    LoadStudy bare = study_;
    bare.external.clear();
    return RunLoadStudy(bare).poses[pose].drives[0].force -
           RunLoadStudy(study_).poses[pose].drives[0].force;
  }

  LoadStudy study_;
};

constexpr double kTable = 1e-12;

TEST_F(LoadTable, IsLinearBetweenRowsAndRepeats) {
  study_.external[0].period = 1;
  EXPECT_NEAR(Against(0), 1, kTable);
  EXPECT_NEAR(Against(1), -1, kTable);
  EXPECT_NEAR(Against(2), 1, kTable);
}

TEST_F(LoadTable, RunsOverTheDriveCoordinate) {
  study_.external[0].over = ExternalLoad::Over::kDriveCoordinate;
  const double start = study_.mechanism.joints[0].start[0];  // 0.5 rad later after 0.25 s
  study_.external[0].at = {start, start + 1, start + 2};
  study_.times = {0.25, 0.75};
  EXPECT_NEAR(Against(0), 1, kTable);
  EXPECT_NEAR(Against(1), -1, kTable);
}

TEST_F(LoadTable, IsInAxesOfTheLinkIfSaid) {
  study_.external[0].at = {0};
  study_.external[0].over = ExternalLoad::Over::kConstant;
  study_.external[0].p_L = {0.3, 0, 0};
  study_.external[0].axes = ExternalLoad::Axes::kLink;
  study_.external[0].wrenches = {{Vector3d(5, 10, 0), Vector3d::Zero()}};
  EXPECT_NEAR(Against(0), 3, kTable);  // 10 N across on a lever of 0.3 m
}

TEST_F(LoadTable, IsNotReadBeyondItsEnd) {
  EXPECT_THAT(Refusal(study_), AllOf(HasSubstr("pose 2"), HasSubstr("'crank'"),
                                     HasSubstr("covers 0 to 1"), HasSubstr("1.25")));
}

}  // namespace
}  // namespace vmech
