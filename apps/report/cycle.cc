#include "vmech/apps/report/cycle.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "vmech/apps/loads/dead_centres.h"
#include "vmech/apps/report/certainty_words.h"
#include "vmech/dynamics/loads/load_result.h"
#include "vmech/mechanisms/freedoms.h"
#include "vmech/studies/read_motion.h"

namespace vmech {
namespace {

constexpr double kDegreesPerRadian = 180 / std::numbers::pi;
constexpr std::string_view kDegree = "°";
constexpr double kRpm = 30 / std::numbers::pi;  // per rad/s
constexpr double kSteady = 1e-9;                // relative change of a speed that is rounding

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
  const bool angle = cycle->axis.unit == kDegree;
  const double first = cycle->values.front(), last = cycle->values.back();
  const bool turns = angle && std::abs(last - first) > 350;
  const double quarter = turns ? std::copysign(90.0, last - first) : (last - first) / 4;
  const double start = turns ? 90 * std::ceil(first / 90 - 1e-6) : first;
  for (int i = 0; i < 4; ++i) {
    const size_t pose = PoseNear(cycle->values, start + i * quarter);
    cycle->marks.push_back({pose, cycle->At(pose)});
  }
}

/// Angles that make a turn, or are beyond one, are counted from the turn in which they begin.
void ShowWithinTurns(Cycle* cycle) {
  const auto [least, greatest] = std::minmax_element(cycle->values.begin(), cycle->values.end());
  const bool within = *greatest - *least < 350 && *least >= -360 && *greatest <= 360;
  if (within) return;
  const double shift = 360 * std::floor((*least + 1e-6) / 360);
  for (double& value : cycle->values) value -= shift;
  cycle->axis.scale = plot::ScaleType::kTurns;
}

/// A line at every dead centre in every turn, named where there is room.
void AddDeadCentres(const LoadStudy& study, const LoadStudyResult& result, Cycle* cycle) {
  constexpr size_t kNamed = 4;
  const auto [least, greatest] = std::minmax_element(cycle->values.begin(), cycle->values.end());
  for (const DeadCentre& centre : FindDeadCentres(study, result)) {
    const double angle = centre.angle * kDegreesPerRadian;
    double at = angle + 360 * std::ceil((*least - angle) / 360 - 1e-9);
    for (; at <= *greatest; at += 360) cycle->dead_centres.push_back({at, "dead centre"});
  }
  if (cycle->dead_centres.size() <= kNamed) return;
  for (plot::Station& station : cycle->dead_centres) station.label.clear();
}

std::string SpeedInWords(const PoseSeries& poses, size_t drive, bool rotation) {
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
  if (axis.unit != kDegree) return plot::FormatShort(value, 3) + " " + axis.unit;
  if (axis.scale != plot::ScaleType::kTurns) return plot::FormatNumber(value, 0) + "°";
  const double turns = std::abs(value - values.front()) / 360;
  const bool ends = pose + 1 == values.size() && turns - std::floor(turns) < 1e-9;
  const double before = std::floor(turns) - (ends ? 1 : 0);  // whole turns
  const double angle = std::round(value) - 360 * std::floor(std::round(value) / 360);
  return plot::FormatNumber(angle, 0) + "°" +
         (before >= 1 ? fmt::format(", turn {:.0f}", before + 1) : "");
}

std::string Cycle::AtTime(double time) const {
  if (drive.empty()) return plot::FormatShort(time, 4) + " s";
  const double position = drive.At(time).position;
  if (axis.unit != kDegree) return plot::FormatShort(1e3 * position, 4) + " mm";
  const double tenths = std::round(10 * kDegreesPerRadian * position);
  return plot::FormatNumber((tenths - 3600 * std::floor(tenths / 3600)) / 10, 1) + "°";
}

std::string Cycle::DeadCentreNear(size_t pose) const {
  if (values.size() < 2) return "";
  const double step = std::abs(values[1] - values[0]);
  for (const plot::Station& centre : dead_centres) {
    if (std::abs(centre.x - values[pose]) <= step / 2) return "dead centre";
  }
  return "";
}

Cycle CycleOf(const LoadStudy& study, const LoadStudyResult& result) {
  Cycle cycle;
  cycle.values.reserve(result.poses.size());
  if (RunsOneWay(study, result)) {
    const JointDrive& drive = study.drives.front();
    const Joint& joint = study.mechanism.joints[static_cast<size_t>(drive.joint)];
    const bool rotation = IsRotation(joint.type, drive.freedom);
    cycle.axis.title =
        (rotation ? "angle of " : "travel of ") + NameOfFreedom(joint, drive.freedom);
    cycle.axis.unit = rotation ? kDegree : "mm";
    cycle.axis.scale = rotation ? plot::ScaleType::kDegrees : plot::ScaleType::kLinear;
    cycle.drive = drive.law;
    const double unit = rotation ? kDegreesPerRadian : 1e3;
    for (const PoseLoads& pose : result.poses) {
      cycle.values.push_back(pose.drives[0].position * unit);
    }
    if (rotation) ShowWithinTurns(&cycle);
    AddDeadCentres(study, result, &cycle);
  } else {
    cycle.axis = {"time", "s"};
    for (const PoseLoads& pose : result.poses) cycle.values.push_back(pose.time);
  }
  AddMarks(&cycle);
  return cycle;
}

std::string DescribeDeadCentres(const LoadStudy& study, const LoadStudyResult& result) {
  std::vector<std::string> items;
  const std::vector<DeadCentre> centres = FindDeadCentres(study, result);
  for (size_t j = 0; j < study.mechanism.joints.size(); ++j) {
    std::vector<std::string> angles;
    for (const DeadCentre& centre : centres) {
      if (centre.joint != static_cast<int>(j)) continue;
      angles.push_back(plot::FormatShort(centre.angle * kDegreesPerRadian, 4) + "°");
    }
    if (angles.empty()) continue;
    items.push_back(study.mechanism.joints[j].name + " turns back at " + Enumerate(angles));
  }
  return Enumerate(items);
}

std::string DescribeMotion(const LoadStudy& study, const LoadStudyResult& result) {
  const PoseSeries& poses = result.poses;
  std::string words;
  if (study.drives.empty() && !study.hand) {
    words = poses.size() > 1 ? "simulated" : "at rest";
  }
  for (size_t i = 0; i < study.drives.size(); ++i) {
    const JointDrive& drive = study.drives[i];
    const Joint& joint = study.mechanism.joints[static_cast<size_t>(drive.joint)];
    words += fmt::format("{}joint {} {}", i == 0 ? "" : ", ", NameOfFreedom(joint, drive.freedom),
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
