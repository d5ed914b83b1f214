#include "vmech/apps/loads/study_results.h"

#include <algorithm>
#include <future>
#include <string>
#include <vector>

#include "vmech/apps/loads/simulation_tables.h"
#include "vmech/apps/loads/tables.h"
#include "vmech/apps/report/load_report.h"
#include "vmech/apps/report/report_date.h"
#include "vmech/mechanisms/files/file_errors.h"

namespace vmech {

void WriteStudyResults(const StudyFile& file, const StudyOutcome& outcome, std::string_view version,
                       int threads, ResultFolder* folder) {
  const std::string date = ReportDate();
  // Rendered while the tables are written, each of which waits for the disk.
  const std::launch how = threads > 1 ? std::launch::async : std::launch::deferred;
  std::future<std::string> report =
      std::async(how, [&] { return RenderLoadReport(file, outcome, version, date); });
  folder->Write("loads.csv", LoadsTable(file, outcome.loads, threads));
  folder->Write("motion.csv", MotionTable(file, outcome.loads, threads));
  folder->Write("joints.csv", JointsTable(file, outcome.loads, threads));
  if (outcome.simulation) {
    folder->Write("energies.csv", EnergiesTable(*outcome.simulation));
    folder->Write("events.csv", EventsTable(file, *outcome.simulation));
  }
  folder->Write("certainty.csv", CertaintyTable(file, outcome.loads));
  folder->Write("bearings.csv", BearingsTable(file, outcome));
  folder->Write("summary.json", SummaryJson(file, outcome));
  folder->Write("report.html", report.get());
  folder->Commit();
}

void RequireNoWarning(const StudyFile& file, const StudyOutcome& outcome) {
  std::vector<FileError> errors;
  for (const std::string& warning : outcome.warnings) {
    errors.push_back({file.path.string(), 0, 0, "", warning});
  }
  if (!errors.empty()) throw FileErrors(errors);
}

bool BearingsMet(const StudyOutcome& outcome) {
  return std::all_of(outcome.bearings.begin(), outcome.bearings.end(),
                     [](const BearingOutcome& b) { return b.bearings.met(); });
}

}  // namespace vmech
