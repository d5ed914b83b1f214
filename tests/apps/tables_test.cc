#include "vmech/apps/loads/tables.h"
#include "vmech/dynamics/loads/load_result.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <sstream>

namespace vmech {
namespace {

constexpr int kPoses = 600;  // more than a thread writes at a time
constexpr double kTurns = 2;

/// A link that turns about z, on a frame; the joint has a name that CSV must quote.
StudyFile TurningStudy(const std::string& joint_name) {
  StudyFile file;
  Mechanism& mechanism = file.study.mechanism;
  mechanism.links.resize(2);
  mechanism.links[0].name = "frame";
  mechanism.links[1].name = "wheel";
  mechanism.joints.resize(1);
  mechanism.joints[0].name = joint_name;
  mechanism.ground = 0;
  file.study.drives = {{.joint = 0}};
  return file;
}

LoadStudyResult TurningResult() {
  LoadStudyResult result;
  result.certainty.resize(1);
  const auto loads = std::make_shared<LoadArrays>(
      LoadArrays::Shape{.poses = kPoses, .drives = 1, .freedoms = {1}, .links = 2});
  for (int i = 0; i < kPoses; ++i) {
    const double angle = kTurns * 2 * std::numbers::pi * i / kPoses;
    loads->times[i] = 0.001 * i;
    loads->drives[i].position = angle;
    loads->drive_forces[i] = -0.0;
    const double wrench[] = {1.0 / 3, -0.0, 1e-300, 1e22, -2.5e-7, angle};
    std::copy_n(wrench, 6, &loads->wrenches[6 * i]);
    loads->power_errors[i] = 0;
    loads->positions[i] = angle;
    loads->rates[i] = loads->accelerations[i] = 0;
    loads->links[2 * i + 1].X_WL.R = Eigen::AngleAxisd(angle, Vector3d::UnitZ()).toRotationMatrix();
  }
  result.poses = PoseSeries(loads);
  return result;
}

std::vector<std::string> Lines(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

/// The values of a row without quoted fields.
std::vector<double> Values(const std::string& line) {
  std::vector<double> values;
  std::istringstream stream(line);
  for (std::string field; std::getline(stream, field, ',');) values.push_back(std::stod(field));
  return values;
}

TEST(LoadsTable, QuotesNamesWithCommasAndQuotationMarks) {
  const StudyFile file = TurningStudy("a,\"b\"");
  const std::string header = Lines(LoadsTable(file, TurningResult(), 1))[0];
  EXPECT_EQ(header,
            "t,drive.position,\"a,\"\"b\"\".fx\",\"a,\"\"b\"\".fy\",\"a,\"\"b\"\".fz\","
            "\"a,\"\"b\"\".mx\",\"a,\"\"b\"\".my\",\"a,\"\"b\"\".mz\",drive.force,power_error");
}

TEST(LoadsTable, NumbersReadBackToTheSameDouble) {
  const LoadStudyResult result = TurningResult();
  const std::vector<std::string> lines = Lines(LoadsTable(TurningStudy("hub"), result, 1));
  ASSERT_EQ(lines.size(), kPoses + 1u);
  for (int i = 0; i < kPoses; ++i) {
    const double angle = result.poses[i].drives[0].position;
    EXPECT_EQ(Values(lines[i + 1]), (std::vector<double>{result.poses[i].time, angle, 1.0 / 3, 0,
                                                         1e-300, 1e22, -2.5e-7, angle, 0, 0}));
  }
}

TEST(LoadsTable, ZeroHasNoSign) {
  const std::string row = Lines(LoadsTable(TurningStudy("hub"), TurningResult(), 1))[1];
  EXPECT_EQ(row, "0,0,0.3333333333333333,0,1e-300,1e+22,-2.5e-07,0,0,0");
}

TEST(Tables, DoNotDependOnTheNumberOfThreads) {
  const StudyFile file = TurningStudy("hub");
  const LoadStudyResult result = TurningResult();
  EXPECT_EQ(LoadsTable(file, result, 1), LoadsTable(file, result, 5));
  EXPECT_EQ(MotionTable(file, result, 1), MotionTable(file, result, 5));
  EXPECT_EQ(JointsTable(file, result, 1), JointsTable(file, result, 5));
}

TEST(MotionTable, QuaternionRunsOnWithoutJumpsThroughWholeTurns) {
  const std::vector<std::string> lines =
      Lines(MotionTable(TurningStudy("hub"), TurningResult(), 1));
  ASSERT_EQ(lines.size(), kPoses + 1u);
  constexpr double kRounding = 1e-12;
  for (int i = 0; i < kPoses; ++i) {
    // Half the angle, without a change of sign after the first turn.
    const double half = kTurns * std::numbers::pi * i / kPoses;
    const std::vector<double> row = Values(lines[i + 1]);
    EXPECT_NEAR(row[4], std::cos(half), kRounding) << i;
    EXPECT_NEAR(row[7], std::sin(half), kRounding) << i;
  }
}

}  // namespace
}  // namespace vmech
