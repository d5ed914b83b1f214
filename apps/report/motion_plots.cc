#include "vmech/apps/report/motion_plots.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "vmech/apps/html/page.h"
#include "vmech/dynamics/loads/motion/grasp_path.h"
#include "vmech/mechanisms/freedoms.h"

namespace vmech {
namespace {

using html::Markup;

constexpr double kDegreesPerRadian = 180 / std::numbers::pi;
constexpr double kThirdWidth = 320;  // of a page: three plots in a row
constexpr double kThirdHeight = 215;

plot::LinePlot Third(std::string title, const Cycle& cycle, plot::Axis y) {
  plot::LinePlot plot;
  plot.title = std::move(title);
  plot.x = cycle.axis;
  plot.y = std::move(y);
  plot.stations = cycle.dead_centres;
  for (plot::Station& station : plot.stations) station.label.clear();
  plot.width = kThirdWidth;
  plot.height = kThirdHeight;
  return plot;
}

/// One of the arrays of LoadArrays over the cycle, a curve for each freedom.
Markup FreedomPlot(const LoadStudy& study, const LoadArrays& loads,
                   const LoadArrays::Array& figures, double unit, const FreedomGroup& group,
                   const Cycle& cycle, plot::LinePlot plot) {
  const Joint& joint = study.mechanism.joints[group.joint];
  plot.description = fmt::format("Joint {}: {} over the cycle.", joint.name, plot.title);
  for (const int freedom : group.freedoms) {
    plot::Series series{NameOfFreedom(joint.type, freedom), cycle.values, {}};
    const size_t offset = static_cast<size_t>(loads.first_freedom[group.joint] + freedom);
    series.y.reserve(loads.pose_count());
    for (size_t i = 0; i < loads.pose_count(); ++i) {
      series.y.push_back(unit * figures[i * loads.freedom_count() + offset]);
    }
    plot.series.push_back(std::move(series));
  }
  return html::Figure(plot::Draw(plot));
}

}  // namespace

std::vector<FreedomGroup> GroupFreedoms(const Mechanism& mechanism, int joint) {
  std::vector<FreedomGroup> groups;
  const std::vector<bool>& rotates = FreedomsOfType(mechanism.joints[joint].type).rotates;
  for (const bool turns : {false, true}) {
    FreedomGroup group{joint, turns, {}};
    for (size_t k = 0; k < rotates.size(); ++k) {
      if (rotates[k] == turns) group.freedoms.push_back(static_cast<int>(k));
    }
    if (!group.freedoms.empty()) groups.push_back(std::move(group));
  }
  return groups;
}

Markup MotionPlots(const LoadStudy& study, const LoadStudyResult& result, const Cycle& cycle,
                   const FreedomGroup& group) {
  const LoadArrays& loads = result.poses.arrays();
  const auto draw = [&](const LoadArrays::Array& figures, double unit, plot::LinePlot plot) {
    return FreedomPlot(study, loads, figures, unit, group, cycle, std::move(plot));
  };
  const plot::Axis position = group.turns ? plot::Axis{"angle", "°"} : plot::Axis{"position", "mm"};
  const std::string rate = group.turns ? "rad/s" : "m/s";
  const bool is_vector = study.mechanism.joints[group.joint].type == JointType::kSpherical;
  return html::FigureRow(
      {draw(loads.positions, group.turns ? kDegreesPerRadian : 1e3,
            Third(is_vector ? "Rotation vector" : "Coordinate", cycle, position)),
       draw(loads.rates, 1, Third("Rate", cycle, {group.turns ? "angular rate" : "rate", rate})),
       draw(loads.accelerations, 1, Third("Acceleration", cycle, {"acceleration", rate + "²"}))});
}

Markup TransmissionPlot(const TransmissionAngle& transmission, const Cycle& cycle) {
  constexpr double kDoubtful = 40;  // [deg]
  plot::Series series{"", cycle.values, {}};
  for (const double angle : transmission.angles) series.y.push_back(angle * kDegreesPerRadian);
  plot::LinePlot plot;
  plot.title = "Transmission angle";
  plot.description = "Transmission angle over the cycle.";
  plot.x = cycle.axis;
  plot.y = {"angle", "°"};
  plot.stations = cycle.dead_centres;
  plot.series = {std::move(series)};
  plot.levels = {{kDoubtful, "40°"}};
  plot.width = 492;
  plot.height = 260;
  return html::Figure(plot::Draw(plot));
}

Markup PathPlot(const LoadStudy& study, const LoadStudyResult& result, const Cycle& cycle,
                int grasp) {
  constexpr double kWidth = 492, kLeast = 220, kMost = 520, kAround = 90;
  const GraspPath path = FindGraspPath(study, result, grasp);
  const double length = CharacteristicLength(study.mechanism);
  if (path.p_WG.empty() || !(path.extent.maxCoeff() > 1e-9 * length)) return {};
  const std::string& name = study.mechanism.grasps[grasp].name;
  const auto [right, up] = path.plane;
  plot::LinePlot plot;
  plot.title = "Path of " + name;
  plot.description = fmt::format("The path of the grasp {}, to scale.", name);
  plot.x = {std::string(1, "xyz"[right]), "mm"};
  plot.y = {std::string(1, "xyz"[up]), "mm"};
  plot.equal_scales = true;
  plot::Series series;
  for (const Vector3d& p : path.p_WG) {
    series.x.push_back(1e3 * p[right]);
    series.y.push_back(1e3 * p[up]);
  }
  if (study.cycle > 0) {
    series.x.push_back(series.x.front());
    series.y.push_back(series.y.front());
  }
  for (const plot::PathMark& mark : cycle.marks) {
    plot.landmarks.push_back({series.x[mark.index], series.y[mark.index], mark.label});
  }
  plot.series = {std::move(series)};
  plot.width = kWidth;
  const double slope = path.extent[up] / path.extent[right];
  plot.height = std::clamp(slope * (kWidth - kAround) + kAround, kLeast, kMost);
  const std::string across(1, "xyz"[path.across()]);
  const double depth = path.extent[path.across()];
  const std::string caption = depth > 1e-9 * length
                                  ? fmt::format("Seen along {}, along which it moves {} mm.",
                                                across, plot::FormatShort(1e3 * depth, 3))
                                  : fmt::format("In the plane across {}.", across);
  return html::Figure(plot::Draw(plot), caption);
}

}  // namespace vmech
