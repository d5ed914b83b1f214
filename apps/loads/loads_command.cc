#include <fmt/format.h>

#include <algorithm>
#include <future>
#include <stdexcept>
#include <thread>

#include "vmech/apps/commands.h"
#include "vmech/apps/console/progress_bar.h"
#include "vmech/apps/files/file_kind.h"
#include "vmech/apps/files/result_folder.h"
#include "vmech/apps/loads/named_study.h"
#include "vmech/apps/loads/tables.h"
#include "vmech/apps/report/cycle.h"
#include "vmech/apps/report/joint_section.h"
#include "vmech/apps/report/load_report.h"
#include "vmech/apps/report/report_date.h"
#include "vmech/base/number_text.h"
#include "vmech/dynamics/bearings/rating.h"
#include "vmech/dynamics/loads/load_result.h"
#include "vmech/dynamics/loads/open_components.h"
#include "vmech/studies/study.h"
#include "vmech/studies/study_reader.h"

namespace vmech {
namespace {

int Threads(const LoadsArguments& arguments) {
  if (arguments.threads > 0) return arguments.threads;
  return std::clamp(static_cast<int>(std::thread::hardware_concurrency()), 1, 64);
}

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

/// @throws FileErrors with every warning.
void RequireNoWarning(const std::filesystem::path& study, const StudyOutcome& outcome) {
  std::vector<FileError> errors;
  for (const std::string& warning : outcome.warnings)
    errors.push_back({study.string(), 0, 0, "", warning});
  if (!errors.empty()) throw FileErrors(errors);
}

void PrintSummary(const StudyFile& file, const StudyOutcome& outcome, const ResultFolder& folder) {
  fmt::print("{}: {}\n{}\n", file.name, file.motion, outcome.loads.BriefReport());
  fmt::print("{}{}", JointLines(file, outcome.loads), RuleLine(file, outcome.loads));
  const std::string centres = DescribeDeadCentres(file.study, outcome.loads);
  if (!centres.empty()) fmt::print("  dead centres: {}\n", centres);
  for (size_t i = 0; i < outcome.bearings.size(); ++i) {
    fmt::print("{}", BearingLines(file, file.bearings[i], outcome.bearings[i]));
  }
  for (const std::string& note : outcome.loads.notes) fmt::print("note: {}\n", note);
  for (const std::string& warning : outcome.warnings) fmt::print("warning: {}\n", warning);
  fmt::print("written to {}\n", (folder.path() / "report.html").string());
}

}  // namespace

int RunLoads(const LoadsArguments& arguments) {
  StudyFile file = ReadAs({"loads", {FileKind::kStudy}}, arguments.study, ReadStudy);
  if (arguments.tolerance) file.study.mechanism.tolerance = *arguments.tolerance;
  LoadStudyOptions options;
  options.threads = Threads(arguments);
  const std::string date = ReportDate();
  const std::filesystem::path by_name = arguments.study.stem().string() + "-loads";
  ResultFolder folder(arguments.out.empty() ? by_name : arguments.out, ResultKind::kLoads);
  StudyOutcome outcome;
  {
    ProgressBar bar("loads", file.study.times.size(), arguments.quiet);
    options.progress = [&](size_t done) {
      bar.Show(done);
      return true;
    };
    outcome = RunNamedStudy(file, options);
  }
  if (arguments.strict) RequireNoWarning(arguments.study, outcome);
  // Rendered while the tables are written, each of which waits for the disk.
  const std::launch how = options.threads > 1 ? std::launch::async : std::launch::deferred;
  std::future<std::string> report =
      std::async(how, [&] { return RenderLoadReport(file, outcome, VMECH_VERSION, date); });
  folder.Write("loads.csv", LoadsTable(file, outcome.loads, options.threads));
  folder.Write("motion.csv", MotionTable(file, outcome.loads, options.threads));
  folder.Write("joints.csv", JointsTable(file, outcome.loads, options.threads));
  folder.Write("certainty.csv", CertaintyTable(file, outcome.loads));
  folder.Write("bearings.csv", BearingsTable(file, outcome));
  folder.Write("summary.json", SummaryJson(file, outcome));
  folder.Write("report.html", report.get());
  folder.Commit();
  if (!arguments.quiet) PrintSummary(file, outcome, folder);
  const bool met = std::all_of(outcome.bearings.begin(), outcome.bearings.end(),
                               [](const BearingOutcome& b) { return b.bearings.met(); });
  return met ? kSuccess : kNotMet;
}

}  // namespace vmech
