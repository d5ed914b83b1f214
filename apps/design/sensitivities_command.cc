#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <thread>

#include "vmech/apps/commands.h"
#include "vmech/apps/design/asked.h"
#include "vmech/apps/design/sensitivity_report.h"
#include "vmech/apps/design/sensitivity_texts.h"
#include "vmech/apps/files/file_kind.h"
#include "vmech/apps/files/parameter_options.h"
#include "vmech/apps/files/result_folder.h"
#include "vmech/apps/loads/named_study.h"
#include "vmech/apps/report/report_date.h"
#include "vmech/studies/sensitivities.h"
#include "vmech/studies/study_reader.h"

namespace vmech {
int RunSensitivities(const SensitivityArguments& arguments) {
  const StudyFile file = ReadWithSettings(arguments.set, [&](auto settings) {
    return ReadAs({"sensitivities", {FileKind::kStudy}}, arguments.study,
                  [&](const auto& path) { return ReadStudy(path, settings); });
  });
  std::optional<ResultFolder> folder;
  if (!arguments.out.empty()) folder.emplace(arguments.out, ResultKind::kSensitivities);
  const int threads = arguments.threads > 0
                          ? arguments.threads
                          : std::clamp<int>(std::thread::hardware_concurrency(), 1, 64);
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
