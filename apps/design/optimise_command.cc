#include <fmt/format.h>

#include <optional>

#include "vmech/apps/commands.h"
#include "vmech/apps/console/option_error.h"
#include "vmech/apps/design/asked.h"
#include "vmech/apps/design/design_texts.h"
#include "vmech/apps/files/result_folder.h"
#include "vmech/apps/loads/named_study.h"
#include "vmech/apps/report/report_date.h"
#include "vmech/mechanisms/files/writer.h"

namespace vmech {
namespace {

DesignTask TaskOf(const OptimiseArguments& arguments, const StudyFile& file,
                  const StudyOutcome& outcome) {
  if (arguments.minimise.empty() && arguments.maximise.empty()) {
    throw OptionError("optimise: say what, by --minimise FIGURE or --maximise FIGURE");
  }
  if (arguments.vary.empty()) {
    throw OptionError("optimise: say by what, as --vary crank/pin.x=40..60");
  }
  const std::vector<Figure> figures = FiguresOf(file, outcome);
  const std::vector<StudyParameter> parameters = ParametersKnown(file);
  DesignTask task;
  task.maximise = arguments.minimise.empty();
  task.objective = FindFigure(figures, task.maximise ? arguments.maximise : arguments.minimise);
  for (const std::string& words : arguments.vary) {
    task.variables.push_back(VariableAsked(parameters, words));
  }
  for (const std::string& words : arguments.keep) {
    task.constraints.push_back(ConstraintAsked(figures, words));
  }
  return task;
}

void RequireDetermined(const DesignTask& task, const StudyFile& file, const StudyOutcome& outcome) {
  std::vector<Figure> figures{task.objective};
  for (const DesignConstraint& constraint : task.constraints) figures.push_back(constraint.figure);
  for (const Figure& figure : figures) {
    const std::string open = NotDeterminedIn(figure, file, outcome);
    if (open.empty()) continue;
    throw std::invalid_argument(
        fmt::format("'{}' is not determined by statics ({}); --undetermined takes the study's rule",
                    figure.name, open));
  }
}

}  // namespace

int RunOptimise(const OptimiseArguments& arguments) {
  const StudyFile file = StudyAsked("optimise", arguments.study, arguments.set);
  std::optional<ResultFolder> folder;
  if (!arguments.out.empty()) folder.emplace(arguments.out, ResultKind::kDesign);
  DesignOptions options;
  options.threads = ThreadsAsked(arguments.threads);
  options.starts = arguments.starts;
  options.program.method = arguments.method == "mma" ? ProgramMethod::kMma : ProgramMethod::kSlsqp;
  LoadStudyOptions how;
  how.threads = options.threads;
  const StudyOutcome outcome = RunNamedStudy(file, how);
  const DesignTask task = TaskOf(arguments, file, outcome);
  if (!arguments.undetermined) RequireDetermined(task, file, outcome);
  const DesignResult result = OptimiseDesign(file, outcome, task, options);
  if (folder) {
    folder->Write("design.csv", DesignTable(task, result));
    folder->Write("mechanism.yaml", WriteMechanism(result.best.study.mechanism));
    folder->Write("report.html",
                  RenderDesignReport(file, task, result, VMECH_VERSION, ReportDate()));
    folder->Commit();
  }
  if (!arguments.quiet) fmt::print("{}", PrintedDesign(file, task, result));
  return result.feasible ? kSuccess : kNotMet;
}

}  // namespace vmech
