#include <fmt/format.h>
#include <fmt/ranges.h>

#include <optional>
#include <string>

#include "vmech/apps/commands.h"
#include "vmech/apps/console/option_error.h"
#include "vmech/apps/design/asked.h"
#include "vmech/apps/design/design_texts.h"
#include "vmech/apps/design/search_state.h"
#include "vmech/apps/files/result_folder.h"
#include "vmech/apps/loads/named_study.h"
#include "vmech/apps/report/report_date.h"
#include "vmech/mechanisms/files/document.h"
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

ProgramMethod MethodOf(const std::string& name) {
  if (name == "ipopt") return ProgramMethod::kIpopt;
  return name == "mma" ? ProgramMethod::kMma : ProgramMethod::kSlsqp;
}

/// All that the course of a search depends on.
std::string QuestionOf(const OptimiseArguments& arguments, const StudyFile& file) {
  std::string question = fmt::format(
      "vmech {} minimise {} maximise {} vary {} keep {} method {} starts {} undetermined {} set {}",
      VMECH_VERSION, arguments.minimise, arguments.maximise, fmt::join(arguments.vary, " "),
      fmt::join(arguments.keep, " "), arguments.method, arguments.starts, arguments.undetermined,
      fmt::join(arguments.set, " "));
  for (const InputFile& input : file.inputs) question += " " + input.sha256;
  return question;
}

/// The search in the folder, as far as it had come.
SearchState OpenSearch(const OptimiseArguments& arguments, const StudyFile& file) {
  SearchState search(arguments.out, QuestionOf(arguments, file));
  const size_t known = search.designs().size();
  if (known > 0 && !arguments.resume) {
    throw FileErrors((arguments.out / SearchState::kFileName).string(),
                     fmt::format("a search was interrupted here after {} designs; --resume goes on "
                                 "with it, or remove this file",
                                 known));
  }
  if (arguments.resume && !arguments.quiet) {
    fmt::print("{}\n", known > 0 ? fmt::format("The search goes on after {} designs.", known)
                                 : "There is no search to go on with; it begins.");
  }
  return search;
}

}  // namespace

int RunOptimise(const OptimiseArguments& arguments) {
  if (arguments.resume && arguments.out.empty()) {
    throw OptionError("optimise: --resume needs --out DIR, the folder of the search");
  }
  const StudyFile file = StudyAsked("optimise", arguments.study, arguments.set);
  std::optional<ResultFolder> folder;
  std::optional<SearchState> search;
  DesignOptions options;
  if (!arguments.out.empty()) {
    search.emplace(OpenSearch(arguments, file));
    folder.emplace(arguments.out, ResultKind::kDesign);
    options.known = search->designs();
    options.progress = [&](const EvaluatedDesign& design) {
      search->Add(design);
      return true;
    };
  }
  options.threads = ThreadsAsked(arguments.threads);
  options.starts = arguments.starts;
  options.program.method = MethodOf(arguments.method);
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
    search->Remove();
  }
  if (!arguments.quiet) fmt::print("{}", PrintedDesign(file, task, result));
  return result.feasible ? kSuccess : kNotMet;
}

}  // namespace vmech
