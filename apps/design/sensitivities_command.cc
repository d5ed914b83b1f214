#include <fmt/format.h>

#include <optional>

#include "vmech/apps/commands.h"
#include "vmech/apps/design/asked.h"
#include "vmech/apps/design/sensitivity_report.h"
#include "vmech/apps/design/sensitivity_texts.h"
#include "vmech/apps/files/result_folder.h"
#include "vmech/apps/loads/named_study.h"
#include "vmech/apps/report/report_date.h"
#include "vmech/studies/sensitivities.h"

namespace vmech {

int RunSensitivities(const SensitivityArguments& arguments) {
  const StudyFile file = StudyAsked("sensitivities", arguments.study, arguments.set);
  std::optional<ResultFolder> folder;
  if (!arguments.out.empty()) folder.emplace(arguments.out, ResultKind::kSensitivities);
  const int threads = ThreadsAsked(arguments.threads);
  LoadStudyOptions how;
  how.threads = threads;
  const StudyOutcome outcome = RunNamedStudy(file, how);
  const Sensitivities result =
      FindSensitivities(file, outcome, FiguresAsked(file, outcome, arguments.of),
                        ParametersAsked(file, arguments.by), {threads, arguments.undetermined});
  if (folder) {
    folder->Write("sensitivities.csv", SensitivityTable(result));
    folder->Write("report.html",
                  RenderSensitivityReport(file, result, VMECH_VERSION, ReportDate()));
    folder->Commit();
  }
  if (!arguments.quiet) fmt::print("{}", PrintedSensitivities(file, result));
  return kSuccess;
}

}  // namespace vmech
