#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <thread>

#include "vmech/apps/commands.h"
#include "vmech/apps/output_folder.h"
#include "vmech/apps/progress_bar.h"
#include "vmech/apps/report/load_report.h"
#include "vmech/apps/study.h"
#include "vmech/apps/study_reader.h"
#include "vmech/apps/tables.h"

namespace vmech {
namespace {

int Threads(const LoadsArguments& arguments) {
  if (arguments.threads > 0) return arguments.threads;
  return std::clamp(static_cast<int>(std::thread::hardware_concurrency()), 1, 64);
}

std::string JointLines(const StudyFile& file, const LoadStudyResult& loads) {
  std::string text = "  joint                radial     axial   tilting moment   (peaks)\n";
  for (size_t j = 0; j < file.study.mechanism.joints.size(); ++j) {
    double radial = 0, axial = 0, tilting = 0;
    for (const PoseLoads& pose : loads.poses) {
      radial = std::max(radial, pose.joints[j].force.head<2>().norm());
      axial = std::max(axial, std::abs(pose.joints[j].force.z()));
      tilting = std::max(tilting, pose.joints[j].moment.head<2>().norm());
    }
    const bool open = std::any_of(loads.certainty[j].begin(), loads.certainty[j].end(),
                                  [](Certainty c) { return c == Certainty::kNotDetermined; });
    text +=
        fmt::format("  {:<16} {:>8.4g} N {:>7.3g} N   {:>10.4g} N m{}\n",
                    file.study.mechanism.joints[j].name, radial, axial, tilting,
                    open ? fmt::format("   partly by the rule '{}'", NameOf(file.study.rule)) : "");
  }
  return text;
}

void PrintSummary(const StudyFile& file, const StudyOutcome& outcome, const OutputFolder& folder) {
  fmt::print("{}: {}\n{}\n", file.name, file.motion, outcome.loads.BriefReport());
  fmt::print("{}", JointLines(file, outcome.loads));
  for (const BearingOutcome& bearing : outcome.bearings) {
    fmt::print("  {}: {}\n", file.study.mechanism.joints[bearing.joint].name,
               bearing.bearings.BriefReport());
  }
  for (const std::string& warning : outcome.warnings) fmt::print("warning: {}\n", warning);
  fmt::print("written to {}\n", (folder.path() / "report.html").string());
}

}  // namespace

int RunLoads(const LoadsArguments& arguments) {
  const StudyFile file = ReadStudy(arguments.study);
  LoadStudyOptions options;
  options.threads = Threads(arguments);
  StudyOutcome outcome;
  {
    ProgressBar bar("loads", file.study.times.size(), arguments.quiet);
    options.progress = [&](size_t done) {
      bar.Show(done);
      return true;
    };
    outcome = RunStudy(file, options);
  }
  const std::filesystem::path folder_name = arguments.study.stem().string() + "-loads";
  OutputFolder folder(arguments.out.empty() ? folder_name : arguments.out);
  folder.Write("loads.csv", LoadsTable(file, outcome.loads, options.threads));
  folder.Write("motion.csv", MotionTable(file, outcome.loads, options.threads));
  folder.Write("certainty.csv", CertaintyTable(file, outcome.loads));
  folder.Write("bearings.csv", BearingsTable(file, outcome));
  folder.Write("summary.json", SummaryJson(file, outcome));
  folder.Write("report.html", RenderLoadReport(file, outcome, VMECH_VERSION));
  folder.Commit();
  if (!arguments.quiet) PrintSummary(file, outcome, folder);
  const bool met = std::all_of(outcome.bearings.begin(), outcome.bearings.end(),
                               [](const BearingOutcome& b) { return b.bearings.complete(); });
  return met ? kSuccess : kNotMet;
}

}  // namespace vmech
