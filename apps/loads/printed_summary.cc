#include "vmech/apps/loads/printed_summary.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>

#include "vmech/apps/report/cycle.h"
#include "vmech/apps/report/joint_section.h"
#include "vmech/base/text/number_text.h"
#include "vmech/dynamics/bearings/rating.h"
#include "vmech/dynamics/loads/load_result.h"
#include "vmech/dynamics/loads/open_components.h"

namespace vmech {
namespace {

/// The components with a verdict, as in ": fz mx my"; empty if there are none.
std::string Components(const JointCertainty& certainty, Certainty verdict) {
  constexpr const char* kNames[] = {"fx", "fy", "fz", "mx", "my", "mz"};
  std::string names;
  for (size_t i = 0; i < certainty.size(); ++i) {
    if (certainty[i] == verdict) names += std::string(names.empty() ? ": " : " ") + kNames[i];
  }
  return names;
}

/// What statics leaves open and no load reaches, as in " fz mx my"; empty if there is none.
std::string UnloadedComponents(JointCertainty certainty, const JointCertainty& matters) {
  for (size_t i = 0; i < certainty.size(); ++i) {
    if (certainty[i] == matters[i]) certainty[i] = Certainty::kCertain;
  }
  const std::string components = Components(certainty, Certainty::kNotDetermined);
  return components.empty() ? "" : components.substr(1);
}

std::string CertaintyInWords(const LoadStudyResult& loads, size_t joint) {
  const JointCertainty matters = VerdictsThatMatter(loads, joint);
  std::string words;
  for (const Certainty verdict : {Certainty::kNotDetermined, Certainty::kSingular}) {
    const std::string components = Components(matters, verdict);
    if (components.empty()) continue;
    words += fmt::format("{}{}{}", words.empty() ? "" : "; ", NameOf(verdict), components);
  }
  if (words.empty()) words = "certain";
  const std::string unloaded = UnloadedComponents(loads.certainty[joint], matters);
  return unloaded.empty() ? words : words + "; no load on" + unloaded;
}

std::string JointLines(const StudyFile& file, const LoadStudyResult& loads) {
  const std::vector<Joint>& joints = file.study.mechanism.joints;
  size_t width = 16;
  for (const Joint& joint : joints) width = std::max(width, joint.name.size());
  std::string text = fmt::format("  {:<{}} {:>11} {:>11} {:>14}   statics\n", "largest loads",
                                 width, "radial [N]", "axial [N]", "tilting [N m]");
  const auto shown = [negligible = Negligible(loads)](double value) {
    return FormatLoad(value, negligible);
  };
  for (size_t j = 0; j < joints.size(); ++j) {
    const JointPeaks peaks = PeaksOf(loads, j);
    text += fmt::format("  {:<{}} {:>11} {:>11} {:>14}   {}\n", joints[j].name, width,
                        shown(peaks.radial), shown(peaks.axial), shown(peaks.tilting),
                        CertaintyInWords(loads, j));
  }
  return text;
}

std::string RuleLine(const StudyFile& file, const LoadStudyResult& loads) {
  bool open = false;
  for (size_t j = 0; j < loads.certainty.size(); ++j) {
    open |= !Components(VerdictsThatMatter(loads, j), Certainty::kNotDetermined).empty();
  }
  if (!open) return "";
  return fmt::format("  what statics does not determine follows the rule '{}'\n",
                     NameOf(file.study.rule));
}

std::string BearingLines(const StudyFile& file, const BearingRequest& request,
                         const BearingOutcome& outcome) {
  const JointBearings& bearings = outcome.bearings;
  std::string text = fmt::format(
      "bearings of {}{}\n", file.study.mechanism.joints[outcome.joint].name,
      bearings.certainty == LoadCertainty::kDependsOnRule
          ? fmt::format(", for loads that follow the rule '{}'", NameOf(file.study.rule))
          : "");
  for (size_t k = 0; k < bearings.selections.size(); ++k) {
    text +=
        fmt::format("  at {:>5} mm  {}\n", FormatShort(1000 * request.arrangement.positions[k], 3),
                    bearings.selections[k].message);
    for (const std::string& warning : bearings.selections[k].warnings) {
      text += fmt::format("               warning: {}\n", warning);
    }
  }
  if (bearings.complete() && bearings.selections.size() > 1) {
    text +=
        fmt::format("  both         life {} of {}{}\n", FormatHours(bearings.system_life_hours),
                    FormatHours(bearings.asked_system_life), bearings.met() ? "" : ": TOO SHORT");
  }
  return text;
}

std::string SimulationLines(const SimulationResult& simulation) {
  std::string text = fmt::format("{}\n", simulation.BriefReport());
  for (const auto& [kind, count] : CountEvents(simulation)) {
    text += fmt::format("  {} times: {}\n", count, NameOf(kind));
  }
  return text;
}

}  // namespace

std::map<SimulationEvent::Kind, int> CountEvents(const SimulationResult& simulation) {
  std::map<SimulationEvent::Kind, int> counts;
  for (const SimulationEvent& event : simulation.events) ++counts[event.kind];
  return counts;
}

void PrintSummary(const StudyFile& file, const StudyOutcome& outcome,
                  const std::filesystem::path& folder) {
  fmt::print("{}: {}\n{}\n", file.name, file.motion, outcome.loads.BriefReport());
  if (outcome.simulation) fmt::print("{}", SimulationLines(*outcome.simulation));
  fmt::print("{}{}", JointLines(file, outcome.loads), RuleLine(file, outcome.loads));
  const std::string centres = DescribeDeadCentres(file.study, outcome.loads);
  if (!centres.empty()) fmt::print("  dead centres: {}\n", centres);
  for (size_t i = 0; i < outcome.bearings.size(); ++i) {
    fmt::print("{}", BearingLines(file, file.bearings[i], outcome.bearings[i]));
  }
  for (const std::string& note : outcome.loads.notes) fmt::print("note: {}\n", note);
  for (const std::string& warning : outcome.warnings) fmt::print("warning: {}\n", warning);
  fmt::print("written to {}\n", (folder / "report.html").string());
}

}  // namespace vmech
