// Strokes, time ratios and transmission angles against the closed forms of textbooks.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "vmech/dynamics/loads/load_result.h"
#include "vmech/dynamics/loads/load_study.h"
#include "vmech/dynamics/loads/motion/freedom_range.h"
#include "vmech/dynamics/loads/motion/grasp_path.h"
#include "vmech/dynamics/loads/motion/transmission_angle.h"
#include "vmech/dynamics/loads/run_load_study.h"

namespace vmech {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr int kPoses = 397;      // so that extremes lie between poses
constexpr double kSpeed = 10;    // of the crank [rad/s]
constexpr double kCubic = 1e-9;  // what a cubic between two poses is off, step^4 / 384

/// z along the given axis.
Posed At(const Vector3d& p, const Vector3d& z = Vector3d::UnitZ()) {
  return {AxesFromZX(z, z.x() == 0 ? Vector3d::UnitX() : Vector3d::UnitY()), p};
}

/// A bar along x, with joints at its ends.
Link Bar(const std::string& name, double length) {
  return {name, {}, {{"a", At({0, 0, 0})}, {"b", At({length, 0, 0})}}};
}

/// One turn of the first joint, beginning at an angle.
LoadStudy OneTurn(Mechanism mechanism, double from) {
  LoadStudy study;
  study.mechanism = std::move(mechanism);
  study.cycle = 2 * kPi / kSpeed;
  for (int i = 0; i < kPoses; ++i) study.times.push_back(study.cycle * i / kPoses);
  study.drives = {{0, 0, MotionLaw::Uniform(from, kSpeed)}};
  study.mechanism.joints[0].start = {from};
  return study;
}

/// Crank r and rod l; the pin of the slider runs along x at the height e.
struct OffsetSliderCrank {
  double r = 0.05, l = 0.15, e = 0.02;

  LoadStudy Study() const {
    Mechanism m;
    const Posed guide = At({0, e, 0}, Vector3d::UnitX()), slide = At({0, 0, 0}, Vector3d::UnitX());
    m.links = {{"frame", {}, {{"main", At({0, 0, 0})}, {"guide", guide}}},
               Bar("crank", r),
               Bar("rod", l),
               {"slider", {}, {{"pin", At({0, 0, 0})}, {"guide", slide}}}};
    m.joints = {MakeJoint("main", JointType::kRevolute, {0, 0}, {1, 0}),
                MakeJoint("pin", JointType::kRevolute, {1, 1}, {2, 0}),
                MakeJoint("wrist", JointType::kRevolute, {2, 1}, {3, 0}),
                MakeJoint("guide", JointType::kPrismatic, {0, 1}, {3, 1})};
    m.joints[3].start = {l};
    m.grasps = {{"middle", 2, At({l / 2, 0, 0}), GraspKind::kPoint}};
    return OneTurn(m, 0.3);
  }
};

TEST(FreedomRange, IsTheStrokeOfAnOffsetSliderCrank) {
  const OffsetSliderCrank m;
  const LoadStudy study = m.Study();
  const FreedomRange range = FindRange(study, RunLoadStudy(study), 3, 0);
  EXPECT_NEAR(range.greatest.value, std::sqrt(std::pow(m.l + m.r, 2) - m.e * m.e), kCubic);
  EXPECT_NEAR(range.least.value, std::sqrt(std::pow(m.l - m.r, 2) - m.e * m.e), kCubic);
  const auto angle = [&](const Extreme& at) {
    return std::remainder(0.3 + kSpeed * at.time, 2 * kPi);
  };
  constexpr double kFlat = 1e-5;  // where a rate is zero its coordinate says little of the angle
  EXPECT_NEAR(angle(range.greatest), std::asin(m.e / (m.l + m.r)), kFlat);
  EXPECT_NEAR(angle(range.least), std::asin(m.e / (m.l - m.r)) - kPi, kFlat);
}

TEST(TimeRatio, OfAnOffsetSliderCrankIsThatOfItsDeadCentres) {
  const OffsetSliderCrank m;
  const LoadStudy study = m.Study();
  const LoadStudyResult result = RunLoadStudy(study);
  const double delta = std::asin(m.e / (m.l - m.r)) - std::asin(m.e / (m.l + m.r));
  const std::optional<TimeRatio> ratio = FindTimeRatio(study, result, 3);
  ASSERT_TRUE(ratio);
  constexpr double kFlat = 1e-4;
  EXPECT_NEAR(ratio->ratio(), (kPi - delta) / (kPi + delta), kFlat);  // it moves out faster
  EXPECT_FALSE(FindTimeRatio(study, result, 0)) << "the drive";
  EXPECT_FALSE(FindTimeRatio(study, result, 1)) << "between two links that move";
}

TEST(TransmissionAngle, OfASliderCrankIsLeastWhereTheCrankIsFarthestFromTheSlide) {
  const OffsetSliderCrank m;
  const LoadStudy study = m.Study();
  const std::optional<TransmissionAngle> found = FindTransmissionAngle(study, RunLoadStudy(study));
  ASSERT_TRUE(found);
  EXPECT_TRUE(found->slides);
  for (int i = 0; i < kPoses; ++i) {
    const double height = m.r * std::sin(0.3 + kSpeed * study.times[i]) - m.e;
    EXPECT_NEAR(found->angles[i], std::acos(std::abs(height) / m.l), 1e-9);
  }
  constexpr double kStep = 2 * kPi / kPoses;
  EXPECT_NEAR(0.3 + kSpeed * study.times[found->least_pose], 1.5 * kPi, kStep);
}

TEST(TransmissionAngle, OfAFourBarObeysTheLawOfCosines) {
  const double crank = 0.2, coupler = 0.5, rocker = 0.4, frame = 0.55;
  Mechanism m;
  m.links = {Bar("frame", frame), Bar("crank", crank), Bar("coupler", coupler),
             Bar("rocker", rocker)};
  m.joints = {MakeJoint("input", JointType::kRevolute, {0, 0}, {1, 0}),
              MakeJoint("pin", JointType::kRevolute, {1, 1}, {2, 0}),
              MakeJoint("knee", JointType::kRevolute, {2, 1}, {3, 1}),
              MakeJoint("output", JointType::kRevolute, {0, 1}, {3, 0})};
  m.joints[3].start = {2};
  const LoadStudy study = OneTurn(m, 1);
  const std::optional<TransmissionAngle> found = FindTransmissionAngle(study, RunLoadStudy(study));
  ASSERT_TRUE(found);
  EXPECT_EQ(found->output, 3);
  for (int i = 0; i < kPoses; ++i) {
    const double theta = 1 + kSpeed * study.times[i];
    const double diagonal2 = crank * crank + frame * frame - 2 * crank * frame * std::cos(theta);
    const double cosine =
        (coupler * coupler + rocker * rocker - diagonal2) / (2 * coupler * rocker);
    EXPECT_NEAR(found->angles[i], std::acos(std::abs(cosine)), 1e-9);
  }
}

TEST(TransmissionAngle, IsLeftOutWhereTheMechanismIsNoPlanarLoopOfFour) {
  LoadStudy study = OffsetSliderCrank().Study();
  const LoadStudyResult result = RunLoadStudy(study);
  study.mechanism.links.push_back({"pendulum", {}, {{"a", At({0, 0, 0})}}});
  EXPECT_FALSE(FindTransmissionAngle(study, result));
}

TEST(GraspPath, LiesInThePlaneOfTheMechanism) {
  const OffsetSliderCrank m;
  const LoadStudy study = m.Study();
  const GraspPath path = FindGraspPath(study, RunLoadStudy(study), 0);
  ASSERT_EQ(path.p_WG.size(), size_t{kPoses});
  EXPECT_EQ(path.across(), 2);
  EXPECT_NEAR(path.extent.y(), m.r, 1e-5);  // halfway between crank pin and slider
}

/// A plate on two slides and a hinge; a planar joint off its centre closes the loop.
TEST(CutJointAccelerations, OfAPlanarJointCountThatItsAnchorMovesOn) {
  const double reach = 0.3;
  Mechanism m;
  const Posed X = At({0, 0, 0}, Vector3d::UnitX()), Y = At({0, 0, 0}, Vector3d::UnitY());
  m.links = {{"table", {}, {{"x", X}, {"plane", Posed()}}},
             {"beam", {}, {{"x", X}, {"y", Y}}},
             {"carriage", {}, {{"y", Y}, {"hinge", Posed()}}},
             {"plate", {}, {{"hinge", Posed()}, {"off", At({reach, 0, 0})}}}};
  m.joints = {MakeJoint("x", JointType::kPrismatic, {0, 0}, {1, 0}),
              MakeJoint("y", JointType::kPrismatic, {1, 1}, {2, 0}),
              MakeJoint("hinge", JointType::kRevolute, {2, 1}, {3, 0}),
              MakeJoint("plane", JointType::kPlanar, {0, 1}, {3, 1})};
  m.preferred_cuts = {3};
  LoadStudy study;
  study.mechanism = m;
  study.times = {0, 0.1};
  study.drives = {{0, 0, MotionLaw::Uniform(0, 1, 2)},
                  {1, 0, MotionLaw::Uniform(0, -1, 3)},
                  {2, 0, MotionLaw::Uniform(0.4, 5, 7)}};
  const LoadStudyResult result = RunLoadStudy(study);
  ASSERT_EQ(result.cut_joints, std::vector<std::string>{"plane"});
  for (const PoseLoads& pose : result.poses) {
    const double angle = 0.4 + 5 * pose.time + 3.5 * pose.time * pose.time, w = 5 + 7 * pose.time;
    const double x = 2 - reach * (7 * std::sin(angle) + w * w * std::cos(angle));
    const double y = 3 + reach * (7 * std::cos(angle) - w * w * std::sin(angle));
    EXPECT_LT((pose.joints[3].acceleration - Vector3d(x, y, 7)).norm(), 1e-11);
  }
}

}  // namespace
}  // namespace vmech
