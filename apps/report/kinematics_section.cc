#include "vmech/apps/report/kinematics_section.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>

#include "vmech/apps/html/page.h"
#include "vmech/apps/report/certainty_words.h"
#include "vmech/apps/report/motion_plots.h"
#include "vmech/dynamics/loads/motion/freedom_range.h"
#include "vmech/dynamics/loads/motion/transmission_angle.h"
#include "vmech/mechanisms/freedoms.h"

namespace vmech {
namespace {

using html::Markup;

constexpr double kDegreesPerRadian = 180 / std::numbers::pi;
constexpr double kRounding = 1e-9;

/// One freedom and how far it goes.
struct Freedom {
  int joint = -1, index = 0;
  bool turns = false;
  FreedomRange range;
  double least_rate = 0, greatest_rate = 0;
  bool moves = false;

  /// At one rate, but for rounding.
  bool IsUniform() const {
    return greatest_rate - least_rate <= kRounding * std::max(range.largest_rate, 1e-300);
  }
  /// In one direction for ever.
  bool TurnsOn(const LoadStudy& study) const {
    return turns && study.cycle > 0 && (least_rate > 0 || greatest_rate < 0);
  }
};

std::vector<Freedom> FreedomsOfStudy(const LoadStudy& study, const LoadStudyResult& result) {
  const LoadArrays& loads = result.poses.arrays();
  const double length = CharacteristicLength(study.mechanism);
  std::vector<Freedom> freedoms;
  for (int j = 0; j < static_cast<int>(study.mechanism.joints.size()); ++j) {
    const std::vector<bool>& rotates = FreedomsOfType(study.mechanism.joints[j].type).rotates;
    for (int k = 0; k < static_cast<int>(rotates.size()); ++k) {
      Freedom freedom{j, k, rotates[k], FindRange(study, result, j, k)};
      const size_t offset = static_cast<size_t>(loads.first_freedom[j] + k);
      freedom.least_rate = freedom.greatest_rate = loads.rates[offset];
      for (size_t i = 1; i < loads.pose_count(); ++i) {
        const double rate = loads.rates[i * loads.freedom_count() + offset];
        freedom.least_rate = std::min(freedom.least_rate, rate);
        freedom.greatest_rate = std::max(freedom.greatest_rate, rate);
      }
      freedom.moves = freedom.range.stroke() > kRounding * (freedom.turns ? 1 : length);
      freedoms.push_back(freedom);
    }
  }
  return freedoms;
}

/// A coordinate as text, "215.3°" or "100.0 mm".
std::string Coordinate(bool turns, double value) {
  constexpr double kNothing = 1e-12;  // rounding, of a unit
  if (std::abs(value) < kNothing) value = 0;
  return turns ? plot::FormatSignificant(value * kDegreesPerRadian, 4) + "°"
               : plot::FormatSignificant(value * 1e3, 4) + " mm";
}

std::vector<Markup> RangeRow(const LoadStudy& study, const Cycle& cycle, const Freedom& freedom) {
  const FreedomRange& range = freedom.range;
  const std::string unit = freedom.turns ? " rad/s" : " m/s";
  std::vector<Markup> row = {NameOfFreedom(study.mechanism.joints[freedom.joint], freedom.index),
                             Coordinate(freedom.turns, range.least.value),
                             cycle.AtTime(range.least.time),
                             Coordinate(freedom.turns, range.greatest.value),
                             cycle.AtTime(range.greatest.time),
                             Coordinate(freedom.turns, range.stroke())};
  if (freedom.TurnsOn(study)) {
    std::fill(row.begin() + 1, row.end() - 1, Markup("–"));
    row.back() = "turns on and on";
  }
  row.emplace_back(plot::FormatSignificant(range.largest_rate, 4) + unit);
  row.emplace_back(freedom.IsUniform()
                       ? "0"
                       : plot::FormatSignificant(range.largest_acceleration, 4) + unit + "²");
  return row;
}

Markup RangeTable(const LoadStudy& study, const Cycle& cycle,
                  const std::vector<Freedom>& freedoms) {
  html::Table table;
  table.columns = {
      {"Joint"},    {"Least", true},  {"At", true},      {"Greatest", true},
      {"At", true}, {"Stroke", true}, {"Fastest", true}, {"Largest acceleration", true}};
  std::vector<std::string> still;
  for (const Freedom& freedom : freedoms) {
    if (freedom.moves) {
      table.rows.push_back(RangeRow(study, cycle, freedom));
    } else {
      still.push_back(NameOfFreedom(study.mechanism.joints[freedom.joint], freedom.index));
    }
  }
  Markup text;
  if (!table.rows.empty()) text += html::RenderTable(table);
  if (!still.empty()) {
    text += html::Paragraph("Standing still: " + Enumerate(still) + ".");
  }
  return text;
}

/// The outputs that go to and fro, with their time ratios; and the dead centres.
Markup TimingInWords(const LoadStudy& study, const LoadStudyResult& result) {
  Markup text;
  const std::string centres = DescribeDeadCentres(study, result);
  if (!centres.empty()) text += html::Paragraph("Dead centres: " + centres + ".");
  for (int j = 0; j < static_cast<int>(study.mechanism.joints.size()); ++j) {
    const std::optional<TimeRatio> ratio = FindTimeRatio(study, result, j);
    if (!ratio) continue;
    text += html::Paragraph(fmt::format(
        "Time ratio of {}: {}. Its coordinate grows during {}° of the drive's turn and falls "
        "during {}°.",
        study.mechanism.joints[j].name, plot::FormatSignificant(ratio->ratio(), 4),
        plot::FormatNumber(ratio->forward * kDegreesPerRadian, 2),
        plot::FormatNumber(ratio->back * kDegreesPerRadian, 2)));
  }
  return text;
}

std::string DefinitionOf(const TransmissionAngle& transmission, const Mechanism& mechanism) {
  const std::string& coupler = mechanism.links[transmission.coupler].name;
  const std::string& output = mechanism.links[transmission.output].name;
  if (transmission.coupler_slides) {
    return fmt::format(
        "what the angle between the push of {} across its slide and the velocity of "
        "the point of {} on which it acts leaves to a right angle",
        coupler, output);
  }
  if (transmission.slides) {
    return fmt::format("between {} and the normal to the slide of {}", coupler, output);
  }
  return fmt::format("between {} and {}", coupler, output);
}

std::string TransmissionInWords(const TransmissionAngle& transmission, const Mechanism& mechanism,
                                const Cycle& cycle) {
  return fmt::format(
      "The transmission angle, {}, is {}° at least, at {}. At 90° the whole force that {} passes "
      "on "
      "drives {}, at 0° nothing of it; below some 40° friction and play count.",
      DefinitionOf(transmission, mechanism),
      plot::FormatNumber(transmission.angles[transmission.least_pose] * kDegreesPerRadian, 2),
      cycle.At(transmission.least_pose), mechanism.links[transmission.coupler].name,
      mechanism.links[transmission.output].name);
}

/// Transmission angle and paths of grasps.
Markup Geometry(const LoadStudy& study, const LoadStudyResult& result, const Cycle& cycle) {
  const std::optional<TransmissionAngle> angle = FindTransmissionAngle(study, result);
  Markup text;
  std::vector<Markup> figures;
  if (angle && std::isfinite(angle->angles[angle->least_pose])) {
    text = html::Paragraph(TransmissionInWords(*angle, study.mechanism, cycle));
    figures.push_back(TransmissionPlot(*angle, cycle));
  }
  for (int grasp = 0; grasp < static_cast<int>(study.mechanism.grasps.size()); ++grasp) {
    Markup path = PathPlot(study, result, cycle, grasp);
    if (!path.empty()) figures.push_back(std::move(path));
  }
  return figures.empty() ? text : text + html::FigureRow(figures);
}

/// The plots of every joint that does more than to move at one rate.
Markup PlotsOfJoints(const LoadStudy& study, const LoadStudyResult& result, const Cycle& cycle,
                     const std::vector<Freedom>& freedoms) {
  Markup plots;
  std::vector<std::string> uniform;
  for (int j = 0; j < static_cast<int>(study.mechanism.joints.size()); ++j) {
    const Joint& joint = study.mechanism.joints[j];
    Markup rows;
    for (const FreedomGroup& group : GroupFreedoms(study.mechanism, j)) {
      bool moves = false, varies = false;
      for (const Freedom& freedom : freedoms) {
        if (freedom.joint != j || freedom.turns != group.turns) continue;
        moves |= freedom.moves;
        varies |= freedom.moves && !freedom.IsUniform();
      }
      if (varies) rows += MotionPlots(study, result, cycle, group);
      if (moves && !varies) uniform.push_back(joint.name);
    }
    if (rows.empty()) continue;
    plots +=
        html::Element("h3", Markup(joint.name) + " " + html::Element("small", NameOf(joint.type)));
    plots += rows;
  }
  if (uniform.empty()) return plots;
  return html::Paragraph("At a constant rate, and without plots: " + Enumerate(uniform) + ".") +
         plots;
}

}  // namespace

Markup KinematicsSection(const LoadStudy& study, const LoadStudyResult& result,
                         const Cycle& cycle) {
  const std::vector<Freedom> freedoms = FreedomsOfStudy(study, result);
  if (freedoms.empty()) return {};
  Markup section = html::Heading(2, "How it moves");
  section += RangeTable(study, cycle, freedoms);
  section += TimingInWords(study, result);
  section += Geometry(study, result, cycle);
  return section + PlotsOfJoints(study, result, cycle, freedoms);
}

}  // namespace vmech
