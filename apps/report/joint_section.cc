#include "vmech/apps/report/joint_section.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "vmech/apps/html/page.h"
#include "vmech/apps/loads/dead_centres.h"
#include "vmech/apps/report/certainty_words.h"
#include "vmech/dynamics/loads/load_result.h"
#include "vmech/dynamics/loads/motion/freedom_range.h"
#include "vmech/dynamics/loads/open_components.h"
#include "vmech/mechanisms/freedoms.h"

namespace vmech {
namespace {

using html::Markup;

/// Of the largest load: less is not worth a label or a plot.
constexpr double kWorthShowing = 1e-6;
constexpr double kRounding = 1e-9;  // of a peak

bool HasPolarDiagram(JointType type) {
  return type == JointType::kRevolute || type == JointType::kCylindrical ||
         type == JointType::kScrew || type == JointType::kPrismatic;
}

/// What the force across and along z is called.
std::array<std::string, 2> ForceNames(JointType type) {
  if (type == JointType::kPrismatic) return {"across the guide", "along the guide"};
  if (HasPolarDiagram(type)) return {"radial", "axial"};
  return {"across z", "along z"};
}

plot::LinePlot ForcePlot(const LoadStudy& study, const LoadStudyResult& result, const Cycle& cycle,
                         size_t joint) {
  const std::array<std::string, 2> names = ForceNames(study.mechanism.joints[joint].type);
  const JointPeaks peaks = PeaksOf(result, joint);
  const double worth = kWorthShowing * std::max(peaks.radial, peaks.axial);
  plot::Series radial{names[0], cycle.values, {}};
  plot::Series axial{names[1], cycle.values, {}};
  radial.mark_peak = peaks.radial > worth;
  axial.mark_peak = peaks.axial > worth;
  for (const PoseLoads& pose : result.poses) {
    const Vector3d& force = pose.joints[joint].force;
    radial.y.push_back(std::hypot(force.x(), force.y()));
    axial.y.push_back(force.z());
  }
  plot::LinePlot plot;
  plot.title = "Load over the cycle";
  plot.description = fmt::format(
      "Joint {}: force {} up to {} N, {} up to {} N.", study.mechanism.joints[joint].name, names[0],
      FormatLoad(peaks.radial, worth), names[1], FormatLoad(peaks.axial, worth));
  plot.x = cycle.axis;
  plot.stations = cycle.dead_centres;
  plot.y = {"force", "N"};
  plot.series = {std::move(radial), std::move(axial)};
  return plot;
}

/// A coordinate in degrees or millimetres. Where it turns on and on it is counted within its turn,
/// and nothing stands at the step from a turn to the next, so that curves break off there.
std::vector<double> CoordinateAxis(const LoadStudyResult& result, size_t joint, size_t freedom,
                                   bool turns) {
  constexpr double kWholeTurn = 360;
  const LoadArrays& loads = result.poses.arrays();
  const size_t offset = static_cast<size_t>(loads.first_freedom[joint]) + freedom;
  const double unit = turns ? 180 / std::numbers::pi : 1e3;
  std::vector<double> values;
  for (size_t i = 0; i < loads.pose_count(); ++i) {
    values.push_back(unit * loads.positions[i * loads.freedom_count() + offset]);
  }
  const auto [least, greatest] = std::minmax_element(values.begin(), values.end());
  if (!turns || *greatest - *least < kWholeTurn) return values;
  double before = 0;
  for (size_t i = 0; i < values.size(); ++i) {
    const double turn = std::floor(values[i] / kWholeTurn);
    values[i] -= kWholeTurn * turn;
    if (i > 0 && turn != before) values[i] = NAN;
    before = turn;
  }
  return values;
}

/// The load over a freedom of the joint itself, where that moves and is not what all plots run
/// over.
Markup OwnCoordinatePlots(const LoadStudy& study, const LoadStudyResult& result,
                          const plot::LinePlot& over_cycle, size_t index) {
  const Joint& joint = study.mechanism.joints[index];
  const std::vector<bool>& rotates = FreedomsOfType(joint.type).rotates;
  const double length = CharacteristicLength(study.mechanism);
  std::vector<Markup> figures;
  for (size_t k = 0; k < rotates.size() && joint.type != JointType::kSpherical; ++k) {
    const int freedom = static_cast<int>(k);
    const FreedomRange range = FindRange(study, result, static_cast<int>(index), freedom);
    if (range.stroke() <= kRounding * (rotates[k] ? 1 : length)) continue;
    const bool is_axis = RunsOneWay(study, result) &&
                         study.drives[0].joint == static_cast<int>(index) &&
                         study.drives[0].freedom == freedom;
    if (is_axis) continue;
    plot::LinePlot plot = over_cycle;
    plot.title = "Load over the joint's own coordinate";
    plot.x = {(rotates[k] ? "angle of " : "position of ") + NameOfFreedom(joint, freedom),
              rotates[k] ? "°" : "mm",
              rotates[k] ? plot::ScaleType::kDegrees : plot::ScaleType::kLinear};
    plot.stations.clear();
    for (plot::Series& series : plot.series) {
      series.x = CoordinateAxis(result, index, k, rotates[k]);
      series.mark_peak = false;
    }
    plot.width = 492;
    plot.height = 260;
    figures.push_back(html::Figure(plot::Draw(plot)));
  }
  return figures.empty()
             ? Markup()
             : html::Details("Over the joint's own coordinate", html::FigureRow(figures));
}

plot::PolarPlot PolarDiagram(const LoadStudy& study, const LoadStudyResult& result,
                             const Cycle& cycle, size_t joint) {
  plot::PolarPlot plot;
  plot.title = "Polar load diagram";
  plot.description = fmt::format("Joint {}: path of the tip of the load across z.",
                                 study.mechanism.joints[joint].name);
  const bool guide = study.mechanism.joints[joint].type == JointType::kPrismatic;
  plot.quantity = std::string(guide ? "force across the guide" : "radial load");
  plot.unit = "N";
  plot.paths.resize(1);
  for (const PoseLoads& pose : result.poses) {
    plot.paths[0].x.push_back(pose.joints[joint].force.x());
    plot.paths[0].y.push_back(pose.joints[joint].force.y());
  }
  plot.marks = cycle.marks;
  return plot;
}

plot::LinePlot MomentPlot(const LoadStudyResult& result, const Cycle& cycle, size_t joint) {
  plot::LinePlot plot;
  plot.title = "Moments over the cycle";
  plot.description = "Moments about the origin of the second anchor, axes of the first.";
  plot.x = cycle.axis;
  plot.stations = cycle.dead_centres;
  plot.y = {"moment", "N m"};
  for (const int axis : {0, 1, 2}) {
    plot::Series series{fmt::format("about {}", "xyz"[axis]), cycle.values, {}};
    for (const PoseLoads& pose : result.poses) series.y.push_back(pose.joints[joint].moment[axis]);
    plot.series.push_back(std::move(series));
  }
  plot.series[1].line = plot::LineStyle::kDashed;
  plot.series[2].line = plot::LineStyle::kDotted;
  return plot;
}

html::Tone ToneOf(Certainty certainty) {
  switch (certainty) {
    case Certainty::kCertain:
      return html::Tone::kGood;
    case Certainty::kNotDetermined:
      return html::Tone::kWarning;
    case Certainty::kSingular:
      break;
  }
  return html::Tone::kBad;
}

/// The verdict on a component, and what is left of it under the loads of the study.
Markup VerdictBadge(Certainty verdict, Certainty matters) {
  if (matters != verdict) return html::Badge("zero by every rule", html::Tone::kNeutral);
  return html::Badge(NameOf(verdict), ToneOf(verdict));
}

Markup ComponentTable(const LoadStudyResult& result, size_t joint, double negligible) {
  constexpr std::array<std::string_view, 6> kNames = {"fx", "fy", "fz", "mx", "my", "mz"};
  const JointCertainty matters = VerdictsThatMatter(result, joint);
  html::Table table;
  table.columns = {{"Component"}, {"Least", true}, {"Greatest", true}, {"Root mean square", true},
                   {"Unit"},      {"Verdict"}};
  for (int i = 0; i < 6; ++i) {
    double least = INFINITY, greatest = -INFINITY, squares = 0;
    for (const PoseLoads& pose : result.poses) {
      const double value = i < 3 ? pose.joints[joint].force[i] : pose.joints[joint].moment[i - 3];
      least = std::min(least, value);
      greatest = std::max(greatest, value);
      squares += value * value;
    }
    const double rms = std::sqrt(squares / static_cast<double>(result.poses.size()));
    const Certainty verdict = result.certainty[joint][static_cast<size_t>(i)];
    table.rows.push_back({html::Element("code", kNames[static_cast<size_t>(i)]),
                          FormatLoad(least, negligible), FormatLoad(greatest, negligible),
                          FormatLoad(rms, negligible), i < 3 ? "N" : "N m",
                          VerdictBadge(verdict, matters[static_cast<size_t>(i)])});
  }
  return html::RenderTable(table);
}

Markup JointSection(const LoadStudy& study, const LoadStudyResult& result, const Cycle& cycle,
                    size_t index, double negligible) {
  const Joint& joint = study.mechanism.joints[index];
  const auto link = [&](AnchorId id) {
    return study.mechanism.links[static_cast<size_t>(id.link)].name;
  };
  Markup section =
      html::Element("h3", Markup(joint.name) + " " + html::Element("small", NameOf(joint.type)));
  section +=
      html::Paragraph(fmt::format("What {} exerts on {}, in the axes of the joint's anchor on {}.",
                                  link(joint.first), link(joint.second), link(joint.first)));
  const plot::LinePlot force = ForcePlot(study, result, cycle, index);
  std::vector<Markup> figures = {html::Figure(plot::Draw(force))};
  if (HasPolarDiagram(joint.type)) {
    figures.push_back(html::Figure(plot::Draw(PolarDiagram(study, result, cycle, index))));
  }
  section += html::FigureRow(figures);
  Markup details = ComponentTable(result, index, negligible);
  double largest = 0;
  for (const PoseLoads& pose : result.poses) {
    largest = std::max(largest, pose.joints[index].moment.cwiseAbs().maxCoeff());
  }
  if (largest > negligible) {
    details += html::FigureRow({html::Figure(plot::Draw(MomentPlot(result, cycle, index)))});
  }
  section += html::Details("All six components", details);
  return section + OwnCoordinatePlots(study, result, force, index);
}

}  // namespace

std::string FormatLoad(double value, double negligible) {
  return std::abs(value) <= negligible ? "0" : FormatSignificant(value, 4);
}

double Negligible(const LoadStudyResult& result) {
  double largest = 0;
  for (size_t i = 0; i < result.certainty.size(); ++i) {
    const JointPeaks peaks = PeaksOf(result, i);
    largest = std::max({largest, peaks.radial, peaks.axial});
  }
  return 1e-9 * largest;
}

JointPeaks PeaksOf(const LoadStudyResult& result, size_t joint) {
  JointPeaks peaks;
  const auto raise = [](double value, size_t pose, double* peak, size_t* at) {
    if (value > *peak * (1 + kRounding)) *at = pose;  // not the next turn by rounding
    *peak = std::max(*peak, value);
  };
  for (size_t i = 0; i < result.poses.size(); ++i) {
    const Wrenchd& wrench = result.poses[i].joints[joint];
    raise(std::hypot(wrench.force.x(), wrench.force.y()), i, &peaks.radial, &peaks.radial_pose);
    raise(std::abs(wrench.force.z()), i, &peaks.axial, &peaks.axial_pose);
    raise(std::hypot(wrench.moment.x(), wrench.moment.y()), i, &peaks.tilting, &peaks.tilting_pose);
  }
  return peaks;
}

Markup JointOverview(const LoadStudy& study, const LoadStudyResult& result, const Cycle& cycle) {
  html::Table table;
  table.columns = {{"Joint"},           {"Type"},     {"Radial [N]", true},    {"at", true},
                   {"Axial [N]", true}, {"at", true}, {"Tilting [N m]", true}, {"Statics"}};
  const double negligible = Negligible(result);
  const auto at = [&](double peak, size_t pose) {
    if (peak <= negligible) return Markup("–");
    const std::string centre = cycle.DeadCentreNear(pose);
    return Markup(cycle.At(pose) + (centre.empty() ? "" : ", " + centre));
  };
  for (size_t i = 0; i < study.mechanism.joints.size(); ++i) {
    const Joint& joint = study.mechanism.joints[i];
    const JointPeaks peaks = PeaksOf(result, i);
    table.rows.push_back({html::Element("strong", joint.name), NameOf(joint.type),
                          FormatLoad(peaks.radial, negligible), at(peaks.radial, peaks.radial_pose),
                          FormatLoad(peaks.axial, negligible), at(peaks.axial, peaks.axial_pose),
                          FormatLoad(peaks.tilting, negligible),
                          CertaintyBadge(VerdictsThatMatter(result, i))});
  }
  return html::Heading(2, "Peak loads of the joints") + html::RenderTable(table) +
         html::Paragraph(
             "Radial is across, axial along the z axis of the joint's first anchor; the "
             "tilting moment turns across z, about the origin of the second anchor.");
}

Markup JointSections(const LoadStudy& study, const LoadStudyResult& result, const Cycle& cycle) {
  Markup sections = html::Heading(2, "Joint by joint");
  const double negligible = Negligible(result);
  for (size_t i = 0; i < study.mechanism.joints.size(); ++i) {
    sections += JointSection(study, result, cycle, i, negligible);
  }
  return sections;
}

}  // namespace vmech
