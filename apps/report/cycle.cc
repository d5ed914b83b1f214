#include "vmech/apps/report/cycle.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "vmech/apps/read_motion.h"

namespace vmech {
namespace {

constexpr double kDegreesPerRadian = 180 / std::numbers::pi;
constexpr double kRpm = 30 / std::numbers::pi;  // per rad/s
constexpr double kSteady = 1e-9;                // relative change of a speed that is rounding

bool RunsOneWay(const PoseArray<PoseLoads>& poses) {
  bool forward = true, backward = true;
  for (size_t i = 1; i < poses.size(); ++i) {
    const double step = poses[i].drives[0].position - poses[i - 1].drives[0].position;
    forward = forward && step > 0;
    backward = backward && step < 0;
  }
  return poses.size() > 1 && (forward || backward);
}

/// The pose nearest to a value of the axis.
size_t PoseNear(const std::vector<double>& values, double value) {
  const auto nearest = std::min_element(values.begin(), values.end(), [value](double a, double b) {
    return std::abs(a - value) < std::abs(b - value);
  });
  return static_cast<size_t>(nearest - values.begin());
}

/// Marks at quarters of the first turn, or of the whole passage if it is not an angle.
void AddMarks(Cycle* cycle) {
  if (cycle->values.size() < 8) return;
  const bool angle = cycle->axis.scale == plot::ScaleType::kDegrees;
  const double first = cycle->values.front(), last = cycle->values.back();
  const bool turns = angle && std::abs(last - first) > 350;
  const double quarter = turns ? std::copysign(90.0, last - first) : (last - first) / 4;
  const double start = turns ? 90 * std::ceil(first / 90 - 1e-6) : first;
  for (int i = 0; i < 4; ++i) {
    const size_t pose = PoseNear(cycle->values, start + i * quarter);
    cycle->marks.push_back({pose, cycle->At(pose)});
  }
}

std::string SpeedInWords(const PoseArray<PoseLoads>& poses, size_t drive, bool rotation) {
  double min = poses.front().drives[drive].velocity, max = min;
  for (const PoseLoads& pose : poses) {
    min = std::min(min, pose.drives[drive].velocity);
    max = std::max(max, pose.drives[drive].velocity);
  }
  const double unit = rotation ? kRpm : 1;
  const std::string_view name = rotation ? "rpm" : "m/s";
  const double largest = std::max(std::abs(min), std::abs(max));
  if (largest == 0) return "stands still";
  const std::string verb = rotation ? "turns" : "moves";
  if (max - min <= kSteady * largest) {
    return fmt::format("{} at {} {}", verb, plot::FormatShort(max * unit, 4), name);
  }
  return fmt::format("{} at {} to {} {}", verb, plot::FormatShort(min * unit, 3),
                     plot::FormatShort(max * unit, 3), name);
}

}  // namespace

std::string Cycle::At(size_t pose) const {
  const double value = values[pose];
  if (axis.scale == plot::ScaleType::kDegrees) return plot::FormatNumber(value, 0) + "°";
  return plot::FormatShort(value, 3) + " " + axis.unit;
}

Cycle CycleOf(const LoadStudy& study, const LoadStudyResult& result) {
  Cycle cycle;
  cycle.values.reserve(result.poses.size());
  if (study.drives.size() == 1 && RunsOneWay(result.poses)) {
    const JointDrive& drive = study.drives.front();
    const Joint& joint = study.mechanism.joints[static_cast<size_t>(drive.joint)];
    const bool rotation = IsRotation(joint.type, drive.freedom);
    cycle.axis.title = (rotation ? "angle of " : "travel of ") + joint.name;
    cycle.axis.unit = rotation ? "°" : "mm";
    cycle.axis.scale = rotation ? plot::ScaleType::kDegrees : plot::ScaleType::kLinear;
    const double unit = rotation ? kDegreesPerRadian : 1e3;
    for (const PoseLoads& pose : result.poses) {
      cycle.values.push_back(pose.drives[0].position * unit);
    }
  } else {
    cycle.axis = {"time", "s"};
    for (const PoseLoads& pose : result.poses) cycle.values.push_back(pose.time);
  }
  AddMarks(&cycle);
  return cycle;
}

std::string DescribeMotion(const LoadStudy& study, const LoadStudyResult& result) {
  const PoseArray<PoseLoads>& poses = result.poses;
  std::string words;
  for (size_t i = 0; i < study.drives.size(); ++i) {
    const JointDrive& drive = study.drives[i];
    const Joint& joint = study.mechanism.joints[static_cast<size_t>(drive.joint)];
    words += fmt::format("{}joint {} {}", i == 0 ? "" : ", ", joint.name,
                         SpeedInWords(poses, i, IsRotation(joint.type, drive.freedom)));
  }
  if (study.hand) {
    const Grasp& grasp = study.mechanism.grasps[static_cast<size_t>(study.hand->grasp)];
    words += fmt::format("{}a hand leads the grasp {}", words.empty() ? "" : ", ", grasp.name);
  }
  const double passage = poses.back().time - poses.front().time;
  const double duration = study.cycle > 0 ? study.cycle : passage;
  const std::string over =
      duration > 0 ? fmt::format(" over {} s", plot::FormatShort(duration, 3)) : "";
  words += fmt::format("; {} {}{}", plot::FormatNumber(static_cast<double>(poses.size()), 0),
                       poses.size() == 1 ? "pose" : "poses", over);
  if (words[0] >= 'a' && words[0] <= 'z') words[0] = static_cast<char>(words[0] - 'a' + 'A');
  return words + ".";
}

}  // namespace vmech
