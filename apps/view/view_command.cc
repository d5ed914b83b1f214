#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <ctime>
#include <fstream>
#include <functional>
#include <iterator>
#include <stdexcept>
#include <string>
#include <utility>

#include "vmech/apps/commands.h"
#include "vmech/apps/common_options.h"
#include "vmech/apps/console/option_error.h"
#include "vmech/apps/files/file_kind.h"
#include "vmech/apps/files/parameter_options.h"
#include "vmech/apps/haptic/recording_page.h"
#include "vmech/apps/loads/named_study.h"
#include "vmech/apps/report/motion_scene.h"
#include "vmech/apps/view/json_text.h"
#include "vmech/apps/view/mechanism_session.h"
#include "vmech/apps/view/meshes.h"
#include "vmech/apps/view/view_page.h"
#include "vmech/kinematics/loops/assembled_mechanism.h"
#include "vmech/mechanisms/files/reader.h"
#include "vmech/studies/study_reader.h"

namespace vmech {
namespace {

constexpr const char* kViewHelp =
    "Shows a mechanism in the browser: any link can be dragged with the mouse, joints have "
    "sliders,\n"
    "and the load of every joint is shown. The motion of a study or of a result folder is played,\n"
    "and so is a recording of `vmech haptic`, beside what its audit says. The page is served on "
    "this machine alone\n"
    "(127.0.0.1), at an address with a random token.";

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

constexpr Taken kTaken{
    "view", {FileKind::kMechanism, FileKind::kStudy, FileKind::kResults, FileKind::kRecording}};

/// Interruptions become something to wait for, in all threads that begin while it lives.
class Interruptions {
 public:
  Interruptions() {
    sigemptyset(&signals_);
    for (const int signal : {SIGINT, SIGTERM, SIGHUP}) sigaddset(&signals_, signal);
    pthread_sigmask(SIG_BLOCK, &signals_, &before_);
  }
  ~Interruptions() { pthread_sigmask(SIG_SETMASK, &before_, nullptr); }
  Interruptions(const Interruptions&) = delete;
  Interruptions& operator=(const Interruptions&) = delete;

  /// True if one came within the time.
  bool Within(std::chrono::nanoseconds time) const {
    const timespec limit{0, static_cast<long>(time.count())};
    return sigtimedwait(&signals_, nullptr, &limit) > 0;
  }

 private:
  sigset_t signals_, before_;
};

/// A page on which nothing can be taken in hand.
class StillPage : public PageSubject {
 public:
  explicit StillPage(std::string page) : page_(std::move(page)) {}
  std::string Page() override { return page_; }
  std::string Do(const nlohmann::json& /*request*/) override { return ""; }
  std::string NewState() override { return ""; }
  std::string State() override { return ""; }

 private:
  std::string page_;
};

/// Shows the subject until an interruption; `run` lets the given time pass [s].
void Serve(PageSubject* subject, const ViewArguments& arguments,
           const std::function<void(double)>& run) {
  const Interruptions interruptions;
  PageSession session(subject, arguments.port);
  fmt::print("{} is shown at\n  {}\nCtrl-C ends it.\n", arguments.file.string(), session.url());
  std::fflush(stdout);
  Clock::time_point last = Clock::now();
  while (!interruptions.Within(std::chrono::milliseconds(4))) {
    const Clock::time_point now = Clock::now();
    run(std::chrono::duration<double>(now - last).count());
    last = now;
    session.Publish();
  }
}

Mechanism Assembled(const fs::path& file, Mechanism mechanism, const ViewArguments& arguments) {
  if (arguments.tolerance) mechanism.tolerance = *arguments.tolerance;
  AssembledMechanism assembled = AssembleMechanism(mechanism);
  if (!assembled.summary.closed) {
    throw std::runtime_error(fmt::format("{}: {}", file.string(), assembled.summary.message));
  }
  for (const std::string& note : assembled.Notes()) fmt::print("note: {}\n", note);
  return std::move(assembled.mechanism);
}

void ServeMechanism(Mechanism assembled, const fs::path& file, const ViewArguments& arguments,
                    const std::function<std::string(const KinematicTree&)>& page,
                    std::unique_ptr<LiveDesign> design) {
  MechanismSession session(std::move(assembled), file, page, std::move(design));
  for (const std::string& note : session.notes()) fmt::print("note: {}\n", note);
  Serve(&session, arguments, [&](double elapsed) { session.Run(elapsed); });
}

void ViewMechanism(const ViewArguments& arguments) {
  const Mechanism read = ReadWithSettings(
      arguments.set, [&](auto settings) { return ReadMechanism(arguments.file, settings); });
  const Mechanism mechanism = Assembled(arguments.file, read, arguments);
  const fs::path folder =
      arguments.meshes.empty() ? MeshFolderOf(arguments.file) : arguments.meshes;
  const std::vector<std::string> meshes = ReadMeshes(mechanism, folder);
  auto design = std::make_unique<LiveDesign>(arguments.file, ParseSettings(arguments.set));
  const std::string sliders = JsonText(design->Sliders());
  const auto page = [&](const KinematicTree& tree) {
    return MechanismPage(tree, meshes, VMECH_VERSION, "mechanism", sliders);
  };
  ServeMechanism(mechanism, arguments.file, arguments, page, std::move(design));
}

void ViewStudy(const ViewArguments& arguments) {
  StudyFile file = ReadWithSettings(
      arguments.set, [&](auto settings) { return ReadStudy(arguments.file, settings); });
  if (arguments.tolerance) file.study.mechanism.tolerance = *arguments.tolerance;
  const StudyOutcome outcome = RunNamedStudy(file, {});
  auto design = std::make_unique<LiveDesign>(file);
  const std::string sliders = JsonText(design->Sliders());
  const std::string page =
      ViewPage(file.name, MotionScene(file, outcome.loads, VMECH_VERSION, "mechanism", sliders));
  const auto same = [&](const KinematicTree&) { return page; };
  ServeMechanism(Assembled(file.mechanism_path, file.study.mechanism, arguments),
                 file.mechanism_path, arguments, same, std::move(design));
}

void ViewStill(std::string text, const ViewArguments& arguments) {
  StillPage page(std::move(text));
  Serve(&page, arguments, [](double) {});
}

/// A folder of `vmech loads` holds the scene in its report.
void ViewResults(const ViewArguments& arguments) {
  const fs::path report = arguments.file / "report.html";
  std::ifstream in(report, std::ios::binary);
  const std::string text(std::istreambuf_iterator<char>(in), {});
  constexpr std::string_view kBegin = "id=\"vmech-scene\">";
  const size_t begin = text.find(kBegin);
  if (begin == std::string::npos) {
    throw FileErrors(report.string(), "holds no motion to be shown; run `vmech loads` again");
  }
  const size_t end = text.find("</script>", begin);
  const std::string scene = text.substr(begin + kBegin.size(), end - begin - kBegin.size());
  ViewStill(ViewPage(arguments.file.filename().string(), scene), arguments);
}

}  // namespace

void AddView(CLI::App* app, ViewArguments* view) {
  CLI::App* command = app->add_subcommand("view", kViewHelp);
  AddFile(command, "FILE", &view->file, "mechanism, study, result folder or recording");
  command
      ->add_option("--meshes", view->meshes,
                   "folder with an STL file for every link, as `vmech import --meshes` writes it "
                   "(default: <mechanism>-meshes beside the file)")
      ->type_name("DIR");
  command->add_option("--port", view->port, "port of the page; 0: any free one")
      ->check(CLI::Range(0, 65535, "0..65535"))
      ->capture_default_str();
  AddSet(command, &view->set);
  AddTolerance(command, &view->tolerance);
}

int RunView(const ViewArguments& arguments) {
  const FileKind kind = KindOfFile(arguments.file);
  const bool computed = kind == FileKind::kResults || kind == FileKind::kRecording;
  if (computed && !arguments.set.empty()) {
    throw OptionError("--set: of a mechanism or a study; what is shown here is computed already");
  }
  switch (kind) {
    case FileKind::kStudy:
      ViewStudy(arguments);
      break;
    case FileKind::kResults:
      ViewResults(arguments);
      break;
    case FileKind::kMechanism:
    case FileKind::kUnknown:
      ViewMechanism(arguments);
      break;
    case FileKind::kRecording:
      ViewStill(ReadRecordingFor("view", arguments.file, RecordingPage), arguments);
      break;
    default:
      RefuseOtherKinds(kTaken, arguments.file);
  }
  return kSuccess;
}

}  // namespace vmech
