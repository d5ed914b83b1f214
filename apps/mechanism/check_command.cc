#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <nlohmann/json.hpp>

#include "vmech/apps/commands.h"
#include "vmech/apps/common_options.h"
#include "vmech/apps/console/option_error.h"
#include "vmech/apps/drawing/mechanism_drawing.h"
#include "vmech/apps/files/file_kind.h"
#include "vmech/apps/files/inputs_apart.h"
#include "vmech/apps/files/output_folder.h"
#include "vmech/apps/files/parameter_options.h"
#include "vmech/apps/mechanism/check.h"
#include "vmech/apps/view/meshes.h"
#include "vmech/apps/view/view_page.h"
#include "vmech/mechanisms/files/document.h"
#include "vmech/mechanisms/files/reader.h"

namespace vmech {
namespace {

constexpr const char* kCheckHelp =
    "Says what vmech understands of a mechanism file: links, joints, loops and where they are "
    "cut,\n"
    "mobility, redundant equations, and how well the loops close. Everything that is wrong with "
    "the\n"
    "file is listed at once, as file:line:column.";

using Json = nlohmann::ordered_json;

/// What came of one file: a text or a JSON object, and what a shell is to know.
struct Checked {
  std::string report;
  ExitCode code = kSuccess;
};

ExitCode CodeOf(const MechanismCheck& check, bool strict) {
  if (!check.closed()) return kNoSolution;
  return strict && !check.doubts.empty() ? kBadInput : kSuccess;
}

/// A picture of a mechanism as text, by the ending of the file that it is for.
std::string PictureOf(const MechanismCheck& check, const CheckArguments& arguments) {
  const std::filesystem::path& file = arguments.draw;
  if (file.extension() == ".svg") return DrawMechanism(check.tree);
  if (file.extension() == ".html") {
    const std::filesystem::path meshes = MeshFolderOf(arguments.mechanisms[0]);
    return MechanismPage(check.tree, ReadMeshes(check.tree.mechanism, meshes), VMECH_VERSION);
  }
  throw OptionError(fmt::format("--draw: the ending of {} does not say what to draw: .svg, .html",
                                Quoted(file.string())));
}

void WritePicture(const MechanismCheck& check, const CheckArguments& arguments) {
  const std::filesystem::path& file = arguments.draw;
  const std::string picture = PictureOf(check, arguments);
  RequireOutputsApart(arguments.mechanisms, {file});
  OutputFolder folder(file.has_parent_path() ? file.parent_path() : ".");
  folder.Write(file.filename().string(), picture);
  folder.Commit();
}

Checked CheckFile(const std::filesystem::path& path, const CheckArguments& arguments) {
  Mechanism mechanism = ReadWithSettings(arguments.set, [&](auto settings) {
    return ReadAs({"check", {FileKind::kMechanism}}, path,
                  [&](const auto& file) { return ReadMechanism(file, settings); });
  });
  if (arguments.tolerance) mechanism.tolerance = *arguments.tolerance;
  const MechanismCheck check = CheckMechanism(mechanism);
  if (!arguments.draw.empty()) WritePicture(check, arguments);
  return {arguments.json ? JsonReport(check, arguments.dh) : TextReport(check, arguments.dh),
          CodeOf(check, arguments.strict)};
}

/// The same of one file among several: a file that is wrong does not keep the others from being
/// checked.
Checked CheckOneOfSeveral(const std::filesystem::path& path, const CheckArguments& arguments) {
  try {
    return CheckFile(path, arguments);
  } catch (const FileErrors& errors) {
    fmt::print(stderr, "{}\n", errors.what());
    Json list = Json::array();
    for (const FileError& error : errors.errors()) list.push_back(ToString(error));
    return {Json{{"errors", list}}.dump(), kBadInput};
  }
}

void PrintTexts(const std::vector<std::filesystem::path>& paths,
                const std::vector<Checked>& checked) {
  for (size_t i = 0; i < paths.size(); ++i) {
    if (checked[i].code == kBadInput) continue;
    fmt::print("{}file        {}\n{}", i == 0 ? "" : "\n", paths[i].string(), checked[i].report);
  }
}

/// One list, an object for every file, with its name.
void PrintJsons(const std::vector<std::filesystem::path>& paths,
                const std::vector<Checked>& checked) {
  Json list = Json::array();
  for (size_t i = 0; i < paths.size(); ++i) {
    Json entry{{"file", paths[i].string()}};
    entry.update(Json::parse(checked[i].report));
    list.push_back(entry);
  }
  fmt::print("{}\n", list.dump(2));
}

}  // namespace

void AddCheck(CLI::App* app, CheckArguments* check) {
  CLI::App* command = app->add_subcommand("check", kCheckHelp);
  command->add_option("MECHANISM", check->mechanisms, "mechanism files, YAML or JSON")
      ->required()
      ->type_name("FILE");
  AddSet(command, &check->set);
  AddTolerance(command, &check->tolerance);
  command->add_flag("--dh", check->dh, "print the Denavit-Hartenberg rows as well");
  command
      ->add_option("--draw", check->draw,
                   "write a picture of the mechanism: FILE.svg, or FILE.html to turn "
                   "and zoom")
      ->type_name("FILE");
  AddStrict(command, &check->strict);
  command->add_flag("--json", check->json, "print JSON instead of text");
}

int RunCheck(const CheckArguments& arguments) {
  if (!arguments.draw.empty() && arguments.mechanisms.size() > 1) {
    throw OptionError(fmt::format("--draw: one mechanism is drawn at a time, and {} are given",
                                  arguments.mechanisms.size()));
  }
  if (arguments.mechanisms.size() == 1) {
    const Checked checked = CheckFile(arguments.mechanisms[0], arguments);
    fmt::print("{}", checked.report);
    return checked.code;
  }
  std::vector<Checked> checked;
  int worst = kSuccess;
  for (const std::filesystem::path& path : arguments.mechanisms) {
    checked.push_back(CheckOneOfSeveral(path, arguments));
    worst = std::max<int>(worst, checked.back().code);
  }
  (arguments.json ? PrintJsons : PrintTexts)(arguments.mechanisms, checked);
  return worst;
}

}  // namespace vmech
