#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>

#include "vmech/apps/loads/dead_centres.h"
#include "vmech/apps/loads/tables.h"
#include "vmech/dynamics/loads/load_result.h"
#include "vmech/dynamics/loads/motion/freedom_range.h"
#include "vmech/dynamics/loads/motion/grasp_path.h"
#include "vmech/dynamics/loads/motion/transmission_angle.h"
#include "vmech/dynamics/loads/open_components.h"
#include "vmech/mechanisms/freedoms.h"

namespace vmech {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kComponents[] = {"fx", "fy", "fz", "mx", "my", "mz"};

/// JSON has no infinity; what is unlimited is null.
Json Finite(double value) {
  return std::isfinite(value) ? Json(value) : Json(nullptr);
}

/// How far and how fast a joint goes, by its freedoms.
Json MotionSummary(const LoadStudy& study, const LoadStudyResult& loads, int j) {
  const Joint& joint = study.mechanism.joints[static_cast<size_t>(j)];
  Json freedoms = Json::array();
  for (int k = 0; k < vmech::FreedomsOf(joint.type); ++k) {
    const FreedomRange range = FindRange(study, loads, j, k);
    freedoms.push_back({{"name", NameOfFreedom(joint.type, k)},
                        {"least", range.least.value},
                        {"least_at", range.least.time},
                        {"greatest", range.greatest.value},
                        {"greatest_at", range.greatest.time},
                        {"stroke", range.stroke()},
                        {"largest_rate", range.largest_rate},
                        {"largest_acceleration", range.largest_acceleration}});
  }
  return freedoms;
}

Json TransmissionSummary(const LoadStudy& study, const LoadStudyResult& loads) {
  const std::optional<TransmissionAngle> transmission = FindTransmissionAngle(study, loads);
  if (!transmission) return nullptr;
  const auto name = [&](int link) { return study.mechanism.links[static_cast<size_t>(link)].name; };
  return {{"input", name(transmission->input)},
          {"coupler", name(transmission->coupler)},
          {"output", name(transmission->output)},
          {"least", Finite(transmission->angles[transmission->least_pose])},
          {"least_at", loads.poses.arrays().times[transmission->least_pose]}};
}

Json GraspSummary(const LoadStudy& study, const LoadStudyResult& loads) {
  Json grasps = Json::array();
  for (size_t g = 0; g < study.mechanism.grasps.size(); ++g) {
    const GraspPath path = FindGraspPath(study, loads, static_cast<int>(g));
    if (path.p_WG.empty()) continue;
    grasps.push_back({{"name", study.mechanism.grasps[g].name},
                      {"path_extent", {path.extent.x(), path.extent.y(), path.extent.z()}}});
  }
  return grasps;
}

Json SimulationSummary(const SimulationResult& simulation) {
  const SimulationStatistics& s = simulation.statistics;
  double error = 0;
  for (const EnergySample& energy : simulation.energies) {
    error = std::max(error, std::abs(energy.error));
  }
  return {{"status", NameOf(simulation.status)},
          {"message", simulation.message},
          {"end", simulation.times.empty() ? 0 : simulation.times.back()},
          {"events", simulation.events.size()},
          {"largest_energy_error", error},
          {"method", NameOf(s.method)},
          {"steps", s.steps},
          {"evaluations", s.evaluations},
          {"error_test_failures", s.error_test_failures},
          {"nonlinear_iterations", s.nonlinear_iterations},
          {"projections", s.projections},
          {"restarts", s.restarts},
          {"largest_drift", s.largest_drift},
          {"largest_closure", s.largest_closure},
          {"seconds", s.seconds}};
}

Json JointSummary(const StudyFile& file, const LoadStudyResult& loads, size_t j) {
  double radial = 0, axial = 0, tilting = 0;
  for (const PoseLoads& pose : loads.poses) {
    radial = std::max(radial, pose.joints[j].force.head<2>().norm());
    axial = std::max(axial, std::abs(pose.joints[j].force.z()));
    tilting = std::max(tilting, pose.joints[j].moment.head<2>().norm());
  }
  Json certainty = Json::array();
  for (Certainty c : loads.certainty[j]) certainty.push_back(NameOf(c));
  const JointCertainty matters = VerdictsThatMatter(loads, j);
  Json open = Json::array();
  for (size_t k = 0; k < matters.size(); ++k) {
    if (matters[k] == Certainty::kNotDetermined) open.push_back(kComponents[k]);
  }
  const std::optional<TimeRatio> ratio = FindTimeRatio(file.study, loads, static_cast<int>(j));
  return {{"name", file.study.mechanism.joints[j].name},
          {"type", NameOf(file.study.mechanism.joints[j].type)},
          {"motion", MotionSummary(file.study, loads, static_cast<int>(j))},
          {"time_ratio", ratio ? Finite(ratio->ratio()) : Json(nullptr)},
          {"peak_radial_force", radial},
          {"peak_axial_force", axial},
          {"peak_tilting_moment", tilting},
          {"certainty", certainty},
          {"open", open}};
}

Json BearingSummary(const StudyFile& file, const BearingOutcome& outcome) {
  Json json{{"joint", file.study.mechanism.joints[outcome.joint].name},
            {"complete", outcome.bearings.complete()},
            {"met", outcome.bearings.met()},
            {"certain", outcome.bearings.certainty == LoadCertainty::kCertain},
            {"system_life_hours", Finite(outcome.bearings.system_life_hours)},
            {"asked_system_life_hours", outcome.bearings.asked_system_life},
            {"positions", Json::array()}};
  for (const BearingSelection& selection : outcome.bearings.selections) {
    Json position{{"message", selection.message}, {"warnings", selection.warnings}};
    if (const Candidate* best = selection.best()) {
      position["designation"] = best->bearing.designation;
      position["fits"] = best->fits();
      if (best->rating) {
        position["life_hours"] = Finite(best->rating->modified_life_hours);
        position["static_safety"] = Finite(best->rating->static_safety);
        position["mean_load"] = best->rating->mean_load;
      }
    }
    json["positions"].push_back(position);
  }
  return json;
}

}  // namespace

std::string SummaryJson(const StudyFile& file, const StudyOutcome& outcome) {
  const LoadStudyResult& loads = outcome.loads;
  Json json{{"study", file.name},
            {"mechanism", file.study.mechanism.name},
            {"mechanism_sha256", DigestOfMechanism(file)},
            {"motion", file.motion},
            {"rule", NameOf(file.study.rule)},
            {"norm_length", loads.norm_length},
            {"poses", loads.poses.size()},
            {"mobility", loads.mobility},
            {"redundant_equations", loads.redundant_equations},
            {"cut_joints", loads.cut_joints},
            {"idle_freedoms", loads.idle},
            {"max_closure_error", Finite(loads.max_closure)},
            {"max_power_error", Finite(loads.max_power_error)},
            {"singular_poses", loads.singular_poses}};
  for (const StatedParameter& parameter : file.parameters) {
    json["parameters"][parameter.name] = {{"value", parameter.figure}, {"unit", parameter.unit}};
  }
  Json drives = Json::array();
  for (size_t k = 0; k < file.study.drives.size(); ++k) {
    double peak = 0;
    for (const PoseLoads& pose : loads.poses) {
      peak = std::max(peak, std::abs(pose.drives[k].force));
    }
    const JointDrive& drive = file.study.drives[k];
    const Joint& joint = file.study.mechanism.joints[drive.joint];
    drives.push_back({{"joint", joint.name},
                      {"freedom", NameOfFreedom(joint.type, drive.freedom)},
                      {"peak_force", peak},
                      {"certainty", NameOf(loads.drive_certainty[k])}});
  }
  json["drives"] = drives;
  json["dead_centres"] = Json::array();
  for (const DeadCentre& centre : FindDeadCentres(file.study, loads)) {
    json["dead_centres"].push_back(
        {{"joint", file.study.mechanism.joints[centre.joint].name}, {"angle", centre.angle}});
  }
  json["joints"] = Json::array();
  for (size_t j = 0; j < file.study.mechanism.joints.size(); ++j) {
    json["joints"].push_back(JointSummary(file, loads, j));
  }
  if (outcome.simulation) json["simulation"] = SimulationSummary(*outcome.simulation);
  json["transmission_angle"] = TransmissionSummary(file.study, loads);
  json["grasps"] = GraspSummary(file.study, loads);
  json["bearings"] = Json::array();
  for (const BearingOutcome& bearing : outcome.bearings) {
    json["bearings"].push_back(BearingSummary(file, bearing));
  }
  json["warnings"] = outcome.warnings;
  json["notes"] = loads.notes;
  return json.dump(2) + "\n";
}

}  // namespace vmech
