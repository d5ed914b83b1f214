#include "vmech/apps/report/load_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "vmech/apps/html/page.h"
#include "vmech/apps/plot/style.h"
#include "vmech/apps/report/bearing_section.h"
#include "vmech/apps/report/certainty_words.h"
#include "vmech/apps/report/cycle.h"
#include "vmech/apps/report/input_section.h"
#include "vmech/apps/report/joint_section.h"
#include "vmech/apps/report/kinematics_section.h"
#include "vmech/apps/report/motion_scene.h"
#include "vmech/apps/report/simulation_section.h"
#include "vmech/apps/view/view_page.h"
#include "vmech/dynamics/loads/load_result.h"
#include "vmech/mechanisms/freedoms.h"
#include "vmech/studies/read_motion.h"

namespace vmech {
namespace {

using html::Markup;

constexpr double kRounding = 1e-9;  // of a peak: what a mean over the cycle may owe to rounding

std::string Number(double value, int digits = 4) {
  return plot::FormatSignificant(value, digits);
}

/// With spaces at which no line breaks.
std::string Unbroken(const std::string& text) {
  std::string unbroken;
  for (char c : text) unbroken += c == ' ' ? std::string("\u00a0") : std::string(1, c);
  return unbroken;
}

/// What all parts of the page are made from.
struct Report {
  const StudyFile& file;
  const StudyOutcome& outcome;
  const LoadStudy& study;
  const LoadStudyResult& result;
  std::string_view version, date;
};

void CheckReport(const Report& report) {
  const size_t joints = report.study.mechanism.joints.size();
  const auto fits = [&](const PoseLoads& pose) {
    return pose.joints.size() == joints && pose.drives.size() == report.study.drives.size() &&
           pose.drives.size() == report.study.drives.size();
  };
  const PoseSeries& poses = report.result.poses;
  if (poses.empty()) throw std::invalid_argument("report: the study has no poses");
  const bool bearings_fit = report.file.bearings.size() == report.outcome.bearings.size();
  if (!bearings_fit || report.result.certainty.size() != joints ||
      !std::all_of(poses.begin(), poses.end(), fits)) {
    throw std::invalid_argument(fmt::format(
        "report: the results do not belong to the mechanism '{}'", report.study.mechanism.name));
  }
}

bool DriveTurns(const LoadStudy& study, size_t drive) {
  const JointDrive& d = study.drives[drive];
  return IsRotation(study.mechanism.joints[static_cast<size_t>(d.joint)].type, d.freedom);
}

std::string DriveName(const LoadStudy& study, size_t drive) {
  const JointDrive& d = study.drives[drive];
  return NameOfFreedom(study.mechanism.joints[static_cast<size_t>(d.joint)], d.freedom);
}

html::Tile LargestForceTile(const Report& report, const Cycle& cycle) {
  double largest = 0;
  size_t joint = 0, pose = 0;
  for (size_t i = 0; i < report.result.poses.size(); ++i) {
    for (size_t j = 0; j < report.result.poses[i].joints.size(); ++j) {
      const double force = report.result.poses[i].joints[j].force.norm();
      if (force > largest * (1 + kRounding)) largest = force, joint = j, pose = i;
    }
  }
  const std::string remark =
      fmt::format("at joint {}, {}", report.study.mechanism.joints[joint].name, cycle.At(pose));
  return {"Largest joint force", Number(largest), "N", remark};
}

double PeakDriveForce(const LoadStudyResult& result, size_t drive) {
  double peak = 0;
  for (const PoseLoads& pose : result.poses) {
    peak = std::max(peak, std::abs(pose.drives[drive].force));
  }
  return peak;
}

/// Of the drives that exert what the first one does, force or torque, the one that exerts most.
size_t HardestDrive(const Report& report) {
  size_t hardest = 0;
  for (size_t k = 1; k < report.study.drives.size(); ++k) {
    if (DriveTurns(report.study, k) == DriveTurns(report.study, 0) &&
        PeakDriveForce(report.result, k) > PeakDriveForce(report.result, hardest)) {
      hardest = k;
    }
  }
  return hardest;
}

html::Tile DriveTile(const Report& report, const Cycle& cycle, size_t drive) {
  double peak = 0, sum = 0;
  size_t at = 0;
  const PoseSeries& poses = report.result.poses;
  for (size_t i = 0; i < poses.size(); ++i) {
    const double force = poses[i].drives[drive].force;
    sum += force;
    if (std::abs(force) > std::abs(peak) * (1 + kRounding)) peak = force, at = i;
  }
  const std::string where = report.study.drives.size() > 1
                                ? fmt::format("joint {}, ", DriveName(report.study, drive))
                                : "";
  const bool turns = DriveTurns(report.study, drive);
  const std::string_view unit = turns ? "N m" : "N";
  const double mean = sum / static_cast<double>(poses.size());
  const std::string shown = std::abs(mean) < kRounding * std::abs(peak) ? "0" : Number(mean, 3);
  return {turns ? "Peak drive torque" : "Peak drive force", Number(peak), unit,
          fmt::format("at {}{}; mean {} {}", where, cycle.At(at), shown, unit)};
}

html::Tile HandTile(const Report& report, const Cycle& cycle) {
  double peak = 0;
  size_t at = 0;
  for (size_t i = 0; i < report.result.poses.size(); ++i) {
    const double force = report.result.poses[i].hand.force.norm();
    if (force > peak * (1 + kRounding)) peak = force, at = i;
  }
  return {"Peak hand force", Number(peak), "N", "at " + cycle.At(at)};
}

/// "life 12 000 h of 10 000 h", of the pair where there are two.
std::string LifeInWords(const JointBearings& bearings, const BearingRequirements& asked) {
  const bool pair = bearings.selections.size() > 1;
  return fmt::format("life {}{} of {}", pair ? "together " : "",
                     Unbroken(FormatHours(bearings.system_life_hours)),
                     Unbroken(FormatHours(pair ? asked.LifeOfPair() : asked.life_hours)));
}

html::Tile BearingTile(const Report& report, size_t index) {
  const BearingRequest& request = report.file.bearings[index];
  const JointBearings& bearings = report.outcome.bearings[index].bearings;
  const std::string& name = report.study.mechanism.joints[static_cast<size_t>(request.joint)].name;
  Markup remark = bearings.complete() ? Markup(LifeInWords(bearings, request.requirements))
                                      : Markup("no bearing of the catalogue fits");
  if (!bearings.met()) {
    remark += " ";
    remark += html::Badge(bearings.complete() ? "too short" : "not met", html::Tone::kBad);
  }
  return {"Bearings at " + name, ChosenBearings(bearings), "", remark};
}

Markup Headline(const Report& report, const Cycle& cycle) {
  std::vector<html::Tile> tiles;
  if (!report.study.mechanism.joints.empty()) tiles.push_back(LargestForceTile(report, cycle));
  if (!report.study.drives.empty()) {
    tiles.push_back(DriveTile(report, cycle, HardestDrive(report)));
  }
  if (report.study.hand) tiles.push_back(HandTile(report, cycle));
  for (size_t i = 0; i < report.file.bearings.size(); ++i) {
    tiles.push_back(BearingTile(report, i));
  }
  return html::Tiles(tiles);
}

Markup Header(const Report& report, const Cycle& cycle) {
  Markup header = html::Element("p", "Joint loads and bearings", "eyebrow");
  header += html::Heading(1, report.file.name);
  header +=
      html::Element("p",
                    Markup("Mechanism ") + html::Element("strong", report.study.mechanism.name) +
                        ". " + DescribeMotion(report.study, report.result),
                    "lead");
  if (!report.file.description.empty()) header += html::Paragraph(report.file.description);
  header += Headline(report, cycle);
  if (!report.result.warnings.empty()) {
    header += html::Notice(
        html::ListOrParagraph({report.result.warnings.begin(), report.result.warnings.end()}),
        html::Tone::kWarning);
  }
  if (!report.result.notes.empty()) {
    header += html::Notice(
        html::ListOrParagraph({report.result.notes.begin(), report.result.notes.end()}),
        html::Tone::kNeutral);
  }
  return header;
}

plot::LinePlot DrivePlot(const LoadStudy& study, const LoadStudyResult& result, const Cycle& cycle,
                         bool turning) {
  plot::LinePlot plot;
  plot.title = turning ? "Drive torque" : "Drive force";
  plot.x = cycle.axis;
  plot.stations = cycle.dead_centres;
  plot.y = {turning ? "torque" : "force", turning ? "N m" : "N"};
  for (size_t i = 0; i < study.drives.size(); ++i) {
    if (DriveTurns(study, i) != turning) continue;
    plot::Series series{DriveName(study, i), cycle.values, {}};
    for (const PoseLoads& pose : result.poses) series.y.push_back(pose.drives[i].force);
    series.mark_peak = study.drives.size() < 4;
    plot.series.push_back(std::move(series));
  }
  plot.description = plot.title + " over the cycle, what each motor exerts.";
  return plot;
}

plot::LinePlot HandPlot(const LoadStudyResult& result, const Cycle& cycle) {
  plot::LinePlot plot;
  plot.title = "Force of the hand";
  plot.description = "What the hand exerts on the grasp, world axes.";
  plot.x = cycle.axis;
  plot.stations = cycle.dead_centres;
  plot.y = {"force", "N"};
  for (const int axis : {0, 1, 2}) {
    plot::Series series{std::string(1, "xyz"[axis]), cycle.values, {}};
    for (const PoseLoads& pose : result.poses) series.y.push_back(pose.hand.force[axis]);
    plot.series.push_back(std::move(series));
  }
  return plot;
}

plot::LinePlot PosePlot(const LoadStudyResult& result, const Cycle& cycle, std::string title,
                        plot::Axis y, double PoseLoads::*value) {
  plot::Series series{title, cycle.values, {}};
  for (const PoseLoads& pose : result.poses) series.y.push_back(pose.*value);
  plot::LinePlot plot;
  plot.title = std::move(title);
  plot.description = plot.title + " over the cycle.";
  plot.x = cycle.axis;
  plot.stations = cycle.dead_centres;
  plot.y = std::move(y);
  plot.series = {std::move(series)};
  return plot;
}

/// Two of these fit into a row.
Markup HalfWide(plot::LinePlot plot) {
  plot.width = 492;
  plot.height = 260;
  return html::Figure(plot::Draw(plot));
}

Markup DriveSection(const Report& report, const Cycle& cycle) {
  Markup section = html::Heading(2, report.study.hand ? "The hand" : "The drive");
  std::vector<Markup> figures;
  for (const bool turning : {true, false}) {
    const plot::LinePlot plot = DrivePlot(report.study, report.result, cycle, turning);
    if (!plot.series.empty()) figures.push_back(HalfWide(plot));
  }
  if (report.study.hand) {
    figures.push_back(HalfWide(HandPlot(report.result, cycle)));
  }
  figures.push_back(
      HalfWide(PosePlot(report.result, cycle, "Power put in", {"power", "W"}, &PoseLoads::power)));
  return section + html::FigureRow(figures);
}

std::string Enumerated(const std::vector<std::string>& names, std::string_view none) {
  return names.empty() ? std::string(none) : Enumerate(names);
}

Markup MethodSection(const Report& report, const Cycle& cycle) {
  const LoadStudyResult& result = report.result;
  html::Table table;
  table.columns = {{"How good"}, {"Figure", true}, {"What it says"}};
  table.rows = {
      {"Power balance", Number(result.max_power_error, 2),
       "largest difference between the power put in and what the links' motion and the losses "
       "take, of the largest of these powers; the wrenches do not enter it"},
      {"Closure of the loops", Number(result.max_closure, 2),
       "largest gap left in a loop, of the mechanism's characteristic length and of one radian"},
      {"Mobility", fmt::format("{}", result.mobility), "freedoms of the closed mechanism"},
      {"Redundant equations", fmt::format("{}", result.redundant_equations),
       "loop equations that repeat others; as many wrench components stay open"},
      {"Singular poses", fmt::format("{}", result.singular_poses.size()),
       "poses at or very near a dead centre"}};
  Markup section = html::Heading(2, "How the numbers were found");
  section += html::Paragraph(
      "Every pose closes the loops exactly; velocities and accelerations come from the loop "
      "equations, not from differences between poses. Recursive Newton-Euler dynamics gives what "
      "the "
      "drive must supply and the wrench at every joint. Each pose is computed by itself. Results "
      "do "
      "not depend on where the loops are cut.");
  section += html::RenderTable(table);
  section += html::Paragraph(
      "Loops cut at: " + Enumerated(result.cut_joints, "none, the chain is open") + ".");
  if (!result.idle.empty()) {
    section += html::Paragraph("Idle, that is free to move without any effect on the loads: " +
                               Enumerate(result.idle) + ".");
  }
  if (report.study.rule == ReactionRule::kMinimumNorm) {
    section += html::Paragraph(
        fmt::format("Minimum norm weighs moments against forces by a length of {} mm.",
                    Number(result.norm_length * 1e3)));
  }
  return section + html::FigureRow({html::Figure(
                       plot::Draw(PosePlot(result, cycle, "Error of the power balance",
                                           {"error, relative", ""}, &PoseLoads::power_error)))});
}

Markup Footer(const Report& report) {
  return html::Element(
      "footer",
      fmt::format("vmech {}{}{}, study {}, mechanism {}. The numbers behind the plots stand in "
                  "loads.csv, motion.csv, joints.csv, certainty.csv and bearings.csv beside this "
                  "page.",
                  report.version, report.date.empty() ? "" : ", ", report.date,
                  report.file.path.filename().string(),
                  report.file.mechanism_path.filename().string()));
}

}  // namespace

std::string RenderLoadReport(const StudyFile& file, const StudyOutcome& outcome,
                             std::string_view version, std::string_view date) {
  const Report report{file, outcome, file.study, outcome.loads, version, date};
  CheckReport(report);
  const Cycle cycle = CycleOf(report.study, report.result);
  Markup body = Header(report, cycle);
  body += html::Heading(2, "The mechanism in motion") + ViewPlace() +
          PrintedMechanism(report.study, report.result);
  if (outcome.simulation) body += SimulationSection(file, *outcome.simulation);
  body += JointOverview(report.study, report.result, cycle);
  body += CertaintySection(report.study, report.result);
  body += BearingSections(file, outcome);
  body += JointSections(report.study, report.result, cycle);
  body += KinematicsSection(report.study, report.result, cycle);
  body += DriveSection(report, cycle);
  body += MethodSection(report, cycle);
  body += InputSection(file, version, date);
  body += Footer(report);
  body += ViewScripts(MotionScene(file, outcome.loads, version));
  return html::RenderPage(file.name + ": joint loads", body, plot::PlotStyleSheet());
}

}  // namespace vmech
